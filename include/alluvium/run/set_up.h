#pragma once

#include <iosfwd>
#include <string>

namespace alluvium::run
{
  struct Model;
  class Checkpoint;

  /**
   * Build the scene that the parameters of @p model describe: domain, grains, mesh, fields at rest, and the contact
   * forces that hold the grains; or grains, mesh and fields as they are in @p from, if that is given. The run will go
   * to @p end_time [s]. File names are relative to @p directory. Writes nothing. Collective.
   */
  void set_up(Model &model, const std::string &directory, Checkpoint *from, double end_time);

  /** Loads of the grains' weight alone. */
  void load_by_gravity(Model &model);
} // namespace alluvium::run
