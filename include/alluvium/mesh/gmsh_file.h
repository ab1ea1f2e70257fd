#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

namespace alluvium::mesh
{
  /** A linear mesh of the plane, as a mesh file of gmsh has it. */
  struct GmshFile
  {
    struct Line
    {
      unsigned int a, b, tag; // nodes, and the physical group of dimension 1
    };

    std::map<std::string, unsigned int>      boundary_names; // physical groups of dimension 1 by name
    std::vector<std::array<double, 2>>       nodes;          // [m]
    unsigned int                             n_corners = 0;  // 3: triangles, 4: quadrilaterals
    std::vector<std::array<unsigned int, 4>> cells;          // nodes around each cell; the fourth of a triangle is none
    std::vector<Line>                        lines;          // those in physical groups

    bool has_triangles() const { return n_corners == 3; }
  };

  /**
   * Read @p text, the content of a .msh file. Throws UserError, with @p path in its text, for whatever makes it useless
   * as a linear plane mesh with named boundaries, cut off or damaged files included.
   */
  GmshFile read_gmsh_file(const std::string &text, const std::string &path);

  /**
   * Turn the cells of @p file counter-clockwise, and see that they are a mesh: convex, side by side, in one piece, with
   * lines on its boundary only. Throws UserError, with @p path in its text.
   */
  void make_valid(GmshFile &file, const std::string &path);
} // namespace alluvium::mesh
