#include <alluvium/mesh/gmsh_file.h>
#include <alluvium/utilities/text_file.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <unordered_map>

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
        if (!old_format)
          {
            find("Entities");
            read_entities();
          }
        find("Nodes");
        read_nodes();
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
        const auto             n = count("the number of names");
        std::set<unsigned int> tags;
        for (std::size_t i = 0; i < n; ++i)
          {
            const auto  dimension = number<int>("a dimension");
            const auto  tag       = number<long long>("a tag");
            std::string name;
            std::getline(in, name);
            const auto first = name.find('"'), last = name.rfind('"');
            check(first != std::string::npos && last > first, "has a physical name without quotes.");
            name = name.substr(first + 1, last - first - 1);
            check(is_utf8(name), "has a physical name that is not UTF-8.");
            if (dimension != 1)
              continue;
            check(tag > 0 && tag < largest_tag,
                  "numbers the physical curve '" + name + "' " + std::to_string(tag) +
                    "; tags are positive and below 1e9.");
            check(file.boundary_names.emplace(name, tag).second,
                  "has two physical curves named '" + name + "'; a name must be unique.");
            check(tags.insert(tag).second, "has two names for the physical curve " + std::to_string(tag) + ".");
          }
        check(!file.boundary_names.empty(),
              "names no physical curve: give every side of the boundary a named physical group in gmsh "
              "(`Physical Curve(\"bottom\") = {1};`).");
      }

      /** Which physical group the curves of format 4.1 are in. */
      void read_entities()
      {
        std::array<std::size_t, 4> n;
        for (std::size_t &n_of_dimension : n)
          n_of_dimension = count("a number of entities");
        for (unsigned int dimension = 0; dimension < 2; ++dimension)
          for (std::size_t i = 0; i < n[dimension]; ++i)
            {
              const auto tag = number<long long>("an entity's tag");
              for (unsigned int k = 0; k < (dimension == 0 ? 3 : 6); ++k)
                number<double>("an entity's box");
              const auto n_groups = count("the number of physical groups");
              for (std::size_t k = 0; k < n_groups; ++k)
                {
                  const auto group = number<long long>("a physical group");
                  if (dimension == 1 && k == 0)
                    group_of_curve[tag] = group;
                }
              if (dimension == 0)
                continue;
              const auto n_ends = count("the number of bounding points");
              for (std::size_t k = 0; k < n_ends; ++k)
                number<long long>("a bounding point");
            }
      }

      void read_nodes()
      {
        double     lower = std::numeric_limits<double>::max(), upper = -lower, size = 0.;
        const auto read_point = [&](const long long tag) {
          const double x = number<double>("x"), y = number<double>("y"), z = number<double>("z");
          check(std::isfinite(x) && std::isfinite(y) && std::isfinite(z),
                "has a node whose coordinates are not finite.");
          lower = std::min(lower, z);
          upper = std::max(upper, z);
          size  = std::max({size, std::abs(x), std::abs(y)});
          check(number_of_node.emplace(tag, file.nodes.size()).second,
                "has node " + std::to_string(tag) + " twice, in $Nodes.");
          file.nodes.push_back({{x, y}});
        };
        if (old_format)
          {
            const auto n = count("the number of nodes");
            for (std::size_t i = 0; i < n; ++i)
              read_point(number<long long>("a node's tag"));
          }
        else
          {
            const auto n_blocks = count("the number of blocks");
            const auto n_nodes  = count("the number of nodes");
            count("the first tag");
            count("the last tag");
            for (std::size_t block = 0; block < n_blocks; ++block)
              {
                number<int>("a dimension");
                number<int>("an entity");
                check(number<int>("`parametric`") == 0,
                      "has parametric nodes; export it without (`Mesh.SaveParametric = 0`).");
                const auto             n = count("the number of nodes in a block");
                std::vector<long long> tags;
                for (std::size_t i = 0; i < n; ++i)
                  tags.push_back(number<long long>("a node's tag"));
                for (const long long tag : tags)
                  read_point(tag);
              }
            check(file.nodes.size() == n_nodes, "has another number of nodes than it says, in $Nodes.");
          }
        check(!file.nodes.empty(), "has no nodes.");
        check(upper - lower <= 1e-9 * size, "is not in the plane z = constant: Alluvium needs a 2-D mesh in x and y.");
        find_end();
      }

      /** Number of corners of gmsh's element @p type. */
      unsigned int n_corners(const int type) const
      {
        switch (type)
          {
            case 15: // point
              return 1;
            case 1: // line
              return 2;
            case 2: // triangle
              return 3;
            case 3: // quadrilateral
              return 4;
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

      /** The nodes of an element with @p n corners; @p group is the physical one. */
      void read_element(const unsigned int n, const long long group)
      {
        std::array<unsigned int, 4> nodes{};
        for (unsigned int k = 0; k < n; ++k)
          {
            const auto tag   = number<long long>("an element's node");
            const auto found = number_of_node.find(tag);
            check(found != number_of_node.end(),
                  "has an element with node " + std::to_string(tag) + ", which is not in $Nodes.");
            nodes[k] = found->second;
            check(std::find(nodes.begin(), nodes.begin() + k, nodes[k]) == nodes.begin() + k,
                  "has an element with node " + std::to_string(tag) + " at two corners.");
          }
        if (n == 2 && group > 0)
          {
            check(group < largest_tag, "has a line in the physical group " + std::to_string(group) + ", above 1e9.");
            file.lines.push_back({nodes[0], nodes[1], static_cast<unsigned int>(group)});
          }
        if (n < 3)
          return;
        check(file.n_corners == 0 || file.n_corners == n, "mixes triangles and quadrilaterals; give only one kind.");
        file.n_corners = n;
        file.cells.push_back(nodes);
      }

      void read_elements()
      {
        if (old_format)
          {
            const auto n = count("the number of elements");
            for (std::size_t i = 0; i < n; ++i)
              {
                number<long long>("an element's tag");
                const auto corners = n_corners(number<int>("an element's type"));
                const auto n_tags  = count("the number of an element's tags");
                long long  group   = 0;
                for (std::size_t k = 0; k < n_tags; ++k)
                  {
                    const auto tag = number<long long>("an element's group");
                    group          = k == 0 ? tag : group;
                  }
                read_element(corners, group);
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
                const auto curve   = group_of_curve.find(number<long long>("an entity"));
                const auto corners = n_corners(number<int>("an element's type"));
                const auto n       = count("the number of elements in a block");
                for (std::size_t i = 0; i < n; ++i)
                  {
                    number<long long>("an element's tag");
                    read_element(corners, corners == 2 && curve != group_of_curve.end() ? curve->second : 0);
                  }
              }
          }
        check(!file.cells.empty(),
              "has no triangles or quadrilaterals. gmsh leaves out a surface without a physical group: add "
              "`Physical Surface(\"fluid\") = {1};`.");
        find_end();
      }

      /** What comes next must be the section's end. */
      void find_end()
      {
        std::string word;
        in >> word;
        check(word == "$End" + current, "goes on with '" + word + "' where $End" + current + " should be.");
      }

      static constexpr long long largest_tag = 1000000000;

      std::istringstream in;
      const std::string &text, &path;
      std::string        current;
      bool               old_format = false;
      // by gmsh's tags
      std::unordered_map<long long, unsigned int> number_of_node;
      std::map<long long, long long>              group_of_curve;
      GmshFile                                    file;
    };
  } // namespace


  GmshFile read_gmsh_file(const std::string &text, const std::string &path)
  {
    return Reader(text, path).read();
  }
} // namespace alluvium::mesh
