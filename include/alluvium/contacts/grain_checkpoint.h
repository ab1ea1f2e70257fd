#pragma once

#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/grains/grain_arrays.h>

#include <mpi.h>

#include <string>

namespace alluvium::contacts
{
  /**
   * Write all grains and contact impulses, which are the same on all ranks, to @p file_name with a checksum. Nothing in
   * it depends on the number of ranks. Collective. Throws UserError if the disk does not take it.
   */
  void save_grains(MPI_Comm                   communicator,
                   const std::string         &file_name,
                   const grains::GrainArrays &grains,
                   const ContactArchive      &contacts);

  /**
   * Read them again, bit for bit, on all ranks. Collective. Throws UserError, naming the file, if it is missing, cut
   * off or altered.
   */
  void load_grains(MPI_Comm             communicator,
                   const std::string   &file_name,
                   grains::GrainArrays &grains,
                   ContactArchive      &contacts);
} // namespace alluvium::contacts
