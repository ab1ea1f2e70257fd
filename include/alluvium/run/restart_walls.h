#pragma once

#include <alluvium/contacts/search/contact_archive.h>
#include <alluvium/grains/grain_arrays.h>
#include <alluvium/grains/periodicity.h>
#include <alluvium/grains/wall.h>

#include <vector>

namespace alluvium::run
{
  /**
   * Make @p archive, of a run whose walls were @p before at t = 0, one of a run whose walls are @p now. A wall that
   * both have in the same place at t = 0 stands where the first run has left it; another one stands where its motion
   * has brought it from t = 0 to @p time [s], in steps of @p time_step [s]; with @p time 0, of a run that held walls
   * and grains, where it was put. Impulses of walls that are no more are dropped. Throws UserError if the archive is
   * not of @p before.
   */
  void fit_to_walls(contacts::ContactArchive               &archive,
                    const std::vector<grains::WallSegment> &before,
                    const std::vector<grains::WallSegment> &now,
                    double                                  time,
                    double                                  time_step);

  /**
   * Throw UserError if a wall that stands where @p archive says presses more than a tenth of its diameter into one of
   * @p grains: no run survives that, whatever its time step.
   */
  void check_room_at_walls(const contacts::ContactArchive         &archive,
                           const std::vector<grains::WallSegment> &walls,
                           const grains::GrainArrays              &grains,
                           const grains::Periodicity              &periodicity);
} // namespace alluvium::run
