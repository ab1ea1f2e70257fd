#pragma once

#include <map>
#include <string>

namespace alluvium::mesh
{
  /** What deal.II's reader does not tell of a mesh file of gmsh. */
  struct GmshFile
  {
    std::map<std::string, unsigned int> boundary_names; // physical groups of dimension 1 by name
    std::size_t                         n_triangles = 0, n_quadrilaterals = 0;
  };

  /**
   * Read format, names and cell types from @p text, the content of a .msh file. Throws UserError, with @p path in its
   * text, for whatever makes it useless as a linear plane mesh with named boundaries.
   */
  GmshFile read_gmsh_file(const std::string &text, const std::string &path);
} // namespace alluvium::mesh
