#include <alluvium/mesh/gmsh_file.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace alluvium::mesh
{
  namespace
  {
    class Reader
    {
    public:
      Reader(const std::string &text, const std::string &path)
        : in(text)
        , text(text)
        , path(path)
      {}

      GmshFile read()
      {
        find("MeshFormat");
        const double version = number<double>("the format's version");
        const int    binary  = number<int>("the file type");
        old_format           = version >= 2. && version < 3.;
        check(old_format || (version >= 4.1 && version < 5.),
              "has format " + std::to_string(version) +
                "; export it from gmsh as version 4.1 or 2.2 (`-format msh41`).");
        check(binary == 0, "is binary; export it from gmsh as ASCII (`Mesh.Binary = 0`).");

        find("PhysicalNames",
             "has no $PhysicalNames: give every side of the boundary a named physical group in gmsh "
             "(`Physical Curve(\"bottom\") = {1};`).");
        read_names();
        find("Nodes");
        check_flatness();
        find("Elements");
        read_elements();
        return file;
      }

    private:
      [[noreturn]] void fail(const std::string &what) const { throw UserError("Mesh file '" + path + "' " + what); }

      void check(const bool condition, const std::string &what) const
      {
        if (!condition)
          fail(what);
      }

      /** Go to the first line of $@p section. */
      void find(const std::string &section, const std::string &if_missing = "")
      {
        std::size_t position = text.find("$" + section);
        // the name must stand alone on its line
        while (position != std::string::npos && position + section.size() + 1 < text.size() &&
               std::isalpha(static_cast<unsigned char>(text[position + section.size() + 1])))
          position = text.find("$" + section, position + 1);
        check(position != std::string::npos,
              if_missing.empty() ? "has no section $" + section + ": it is not a gmsh mesh, or it is cut off."
                                 : if_missing);
        in.clear();
        in.seekg(position + section.size() + 1);
        current = section;
      }

      template <typename T>
      T number(const std::string &what)
      {
        T value;
        check(static_cast<bool>(in >> value),
              "ends or has something else where " + what + " should be, in $" + current + ".");
        return value;
      }

      std::size_t count(const std::string &what)
      {
        const auto value = number<long long>(what);
        check(value >= 0, "has a negative number where " + what + " should be, in $" + current + ".");
        return value;
      }

      void read_names()
      {
        const auto n = count("the number of names");
        for (std::size_t i = 0; i < n; ++i)
          {
            const auto  dimension = number<int>("a dimension");
            const auto  tag       = number<unsigned int>("a tag");
            std::string name;
            std::getline(in, name);
            const auto first = name.find('"'), last = name.rfind('"');
            check(first != std::string::npos && last > first, "has a physical name without quotes.");
            name = name.substr(first + 1, last - first - 1);
            if (dimension == 1)
              check(file.boundary_names.emplace(name, tag).second,
                    "has two physical curves named '" + name + "'; a name must be unique.");
          }
        check(!file.boundary_names.empty(),
              "names no physical curve: give every side of the boundary a named physical group in gmsh "
              "(`Physical Curve(\"bottom\") = {1};`).");
      }

      void check_flatness()
      {
        double     lower = std::numeric_limits<double>::max(), upper = -lower, size = 0.;
        const auto read_point = [&] {
          const double x = number<double>("x"), y = number<double>("y"), z = number<double>("z");
          check(std::isfinite(x) && std::isfinite(y) && std::isfinite(z),
                "has a node whose coordinates are not finite.");
          lower = std::min(lower, z);
          upper = std::max(upper, z);
          size  = std::max({size, std::abs(x), std::abs(y)});
        };
        std::size_t n_points = 0;
        if (old_format)
          {
            n_points = count("the number of nodes");
            for (std::size_t i = 0; i < n_points; ++i)
              {
                number<long long>("a node's tag");
                read_point();
              }
          }
        else
          {
            const auto n_blocks = count("the number of blocks");
            count("the number of nodes");
            count("the first tag");
            count("the last tag");
            for (std::size_t block = 0; block < n_blocks; ++block)
              {
                number<int>("a dimension");
                number<int>("an entity");
                check(number<int>("`parametric`") == 0,
                      "has parametric nodes; export it without (`Mesh.SaveParametric = 0`).");
                const auto n = count("the number of nodes in a block");
                for (std::size_t i = 0; i < n; ++i)
                  number<long long>("a node's tag");
                for (std::size_t i = 0; i < n; ++i)
                  read_point();
                n_points += n;
              }
          }
        check(n_points > 0, "has no nodes.");
        check(upper - lower <= 1e-9 * size, "is not in the plane z = constant: Alluvium needs a 2-D mesh in x and y.");
      }

      void add(const int type, const std::size_t n)
      {
        // gmsh's numbers of element types
        switch (type)
          {
            case 1:  // line
            case 15: // point
              break;
            case 2:
              file.n_triangles += n;
              break;
            case 3:
              file.n_quadrilaterals += n;
              break;
            case 4:
            case 5:
            case 6:
            case 7:
            case 11:
            case 12:
            case 13:
            case 14:
            case 17:
            case 18:
            case 19:
              fail("is a 3-D mesh; Alluvium needs a 2-D one of triangles or quadrilaterals (`gmsh -2`).");
            default:
              fail("has elements of gmsh's type " + std::to_string(type) +
                   "; only linear triangles or quadrilaterals are understood (`Mesh.ElementOrder = 1`).");
          }
      }

      void read_elements()
      {
        std::string rest;
        if (old_format)
          {
            const auto n = count("the number of elements");
            for (std::size_t i = 0; i < n; ++i)
              {
                number<long long>("an element's tag");
                add(number<int>("an element's type"), 1);
                std::getline(in, rest);
              }
          }
        else
          {
            const auto n_blocks = count("the number of blocks");
            count("the number of elements");
            count("the first tag");
            count("the last tag");
            for (std::size_t block = 0; block < n_blocks; ++block)
              {
                number<int>("a dimension");
                number<int>("an entity");
                const int  type = number<int>("an element's type");
                const auto n    = count("the number of elements in a block");
                add(type, n);
                std::getline(in, rest);
                for (std::size_t i = 0; i < n; ++i)
                  check(static_cast<bool>(std::getline(in, rest)), "ends within $Elements.");
              }
          }
        check(text.find("$EndElements") != std::string::npos, "ends within $Elements.");
        check(file.n_triangles + file.n_quadrilaterals > 0,
              "has no triangles or quadrilaterals. gmsh leaves out a surface without a physical group: add "
              "`Physical Surface(\"fluid\") = {1};`.");
        check(file.n_triangles == 0 || file.n_quadrilaterals == 0,
              "mixes triangles and quadrilaterals; give only one kind.");
      }

      std::istringstream in;
      const std::string &text, &path;
      std::string        current;
      bool               old_format = false;
      GmshFile           file;
    };
  } // namespace


  GmshFile read_gmsh_file(const std::string &text, const std::string &path)
  {
    return Reader(text, path).read();
  }
} // namespace alluvium::mesh
