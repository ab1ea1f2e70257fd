#pragma once

namespace alluvium::run
{
  struct Model;

  /**
   * Throws UserError if the scene's lengths are impossible: its unrefined mesh alone would have more than `Max cells`,
   * or the domain is more than `Max diameters across` wide with hardly a grain in it. Most often that is a unit of
   * length, which the message guesses. To be called when the grains are made, before the mesh is. The same on all
   * ranks.
   */
  void check_scene_size(const Model &model);

  /** Throws UserError if the mesh, which may come from a file, has more than `Max cells`. */
  void check_mesh_size(const Model &model, double n_cells);
} // namespace alluvium::run
