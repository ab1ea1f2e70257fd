#include <alluvium/mesh/gmsh_file.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <sstream>
#include <unordered_map>

namespace alluvium::mesh
{
  namespace
  {
    constexpr double smallest_sine = 1e-6; // of a corner

    /** The cells on both sides of an edge; its right one sees it the other way round. */
    struct Edge
    {
      std::size_t left = none, right = none;

      static constexpr std::size_t none = -1;
    };

    std::uint64_t key(const unsigned int a, const unsigned int b)
    {
      return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
    }

    class Validator
    {
    public:
      Validator(GmshFile &file, const std::string &path)
        : file(file)
        , path(path)
      {}

      void check()
      {
        for (std::size_t c = 0; c < file.cells.size(); ++c)
          turn(file.cells[c]);
        for (std::size_t c = 0; c < file.cells.size(); ++c)
          add_edges(c);
        check_lines();
        check_that_one_piece();
      }

    private:
      [[noreturn]] void fail(const std::string &what) const { throw UserError("Mesh file '" + path + "' " + what); }

      std::string middle_of(const std::vector<unsigned int> &nodes) const
      {
        double x = 0., y = 0.;
        for (const auto node : nodes)
          {
            x += file.nodes[node][0] / nodes.size();
            y += file.nodes[node][1] / nodes.size();
          }
        std::ostringstream text;
        text << "(" << x << ", " << y << ") m";
        return text.str();
      }

      std::string place(const std::array<unsigned int, 4> &cell) const
      {
        return middle_of(std::vector<unsigned int>(cell.begin(), cell.begin() + file.n_corners));
      }

      /** Counter-clockwise, all corners to the left. */
      void turn(std::array<unsigned int, 4> &cell) const
      {
        const unsigned int n      = file.n_corners;
        unsigned int       n_left = 0, n_right = 0;
        for (unsigned int k = 0; k < n; ++k)
          {
            const auto &a = file.nodes[cell[k]], &b = file.nodes[cell[(k + 1) % n]], &c = file.nodes[cell[(k + 2) % n]];
            const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - b[0], vy = c[1] - b[1];
            const double turns = ux * vy - uy * vx, size = std::hypot(ux, uy) * std::hypot(vx, vy);
            n_left += turns > smallest_sine * size;
            n_right += turns < -smallest_sine * size;
          }
        if (n_right == n)
          std::swap(cell[1], cell[n - 1]);
        else if (n_left != n)
          fail("has " + std::string(n == 3 ? "a triangle without area" : "a quadrilateral that is not convex") +
               " at " + place(cell) + ".");
      }

      void add_edges(const std::size_t c)
      {
        const auto &cell = file.cells[c];
        for (unsigned int k = 0; k < file.n_corners; ++k)
          {
            const unsigned int a = cell[k], b = cell[(k + 1) % file.n_corners];
            Edge              &edge = edges[key(a, b)];
            auto              &side = a < b ? edge.left : edge.right;
            if (side != Edge::none)
              fail("has two cells that lie on one another, or more than two along one edge, at " + middle_of({a, b}) +
                   ".");
            side = c;
          }
      }

      void check_lines() const
      {
        for (const auto &line : file.lines)
          {
            const auto edge = edges.find(key(line.a, line.b));
            if (edge == edges.end())
              fail("has a line in physical curve " + name_of(line.tag) + " at " + middle_of({line.a, line.b}) +
                   " that is no side of a cell.");
            if (edge->second.left != Edge::none && edge->second.right != Edge::none)
              fail("has physical curve " + name_of(line.tag) + " inside the mesh, at " + middle_of({line.a, line.b}) +
                   ". A boundary has cells on one side only; gmsh's plugin Crack makes one of a line inside.");
          }
      }

      std::string name_of(const unsigned int tag) const
      {
        for (const auto &[name, other] : file.boundary_names)
          if (other == tag)
            return "'" + name + "'";
        return std::to_string(tag);
      }

      void check_that_one_piece() const
      {
        std::vector<std::size_t> parent(file.cells.size());
        std::iota(parent.begin(), parent.end(), 0);
        const auto root = [&](std::size_t c) {
          while (parent[c] != c)
            c = parent[c] = parent[parent[c]];
          return c;
        };
        for (const auto &[key, edge] : edges)
          if (edge.left != Edge::none && edge.right != Edge::none)
            parent[root(edge.left)] = root(edge.right);
        for (std::size_t c = 1; c < file.cells.size(); ++c)
          if (root(c) != root(0))
            fail("is not in one piece: no cells lead from " + place(file.cells[0]) + " to " + place(file.cells[c]) +
                 ".");
      }

      GmshFile                               &file;
      const std::string                      &path;
      std::unordered_map<std::uint64_t, Edge> edges;
    };
  } // namespace


  void make_valid(GmshFile &file, const std::string &path)
  {
    Validator(file, path).check();
  }
} // namespace alluvium::mesh
