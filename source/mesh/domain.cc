#include <alluvium/grains/wall_crossing.h>
#include <alluvium/mesh/bisection.h>
#include <alluvium/mesh/domain.h>
#include <alluvium/mesh/gmsh_file.h>
#include <alluvium/mesh/straight_sides.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/input_files.h>
#include <alluvium/utilities/magnitudes.h>
#include <alluvium/utilities/text_file.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

namespace alluvium::mesh
{
  using namespace dealii;

  namespace
  {
    /** What deal.II has to say about an exception of its own, without the stack trace. */
    std::string message_of(const std::exception &error)
    {
      std::ostringstream text;
      if (const auto *e = dynamic_cast<const ExceptionBase *>(&error))
        e->print_info(text);
      else
        text << error.what();
      return Utilities::trim(text.str());
    }

    template <int dim>
    void make_from(Triangulation<dim> &triangulation, const GmshFile &file, const std::string &path)
    {
      std::vector<Point<dim>> vertices;
      for (const auto &node : file.nodes)
        vertices.emplace_back(node[0], node[1]);
      std::vector<CellData<dim>> cells;
      for (const auto &nodes : file.cells)
        {
          cells.emplace_back(file.n_corners);
          for (unsigned int k = 0; k < file.n_corners; ++k) // deal.II's order of quadrilaterals is no way round
            cells.back().vertices[k] = nodes[file.n_corners == 4 && k > 1 ? 5 - k : k];
        }
      SubCellData sides;
      for (const auto &line : file.lines)
        {
          CellData<1> side;
          side.vertices    = {line.a, line.b};
          side.boundary_id = line.tag;
          sides.boundary_lines.push_back(side);
        }
      try
        {
          GridTools::delete_unused_vertices(vertices, cells, sides);
          if (file.n_corners == 4)
            GridTools::consistently_order_cells(cells);
          triangulation.create_triangulation(vertices, cells, sides);
        }
      catch (const std::exception &error)
        {
          throw UserError("Mesh file '" + path + "' cannot be used: " + message_of(error));
        }
    }

    /** @p sides, of which what belongs to @p part is on its own and has its name. */
    std::vector<grains::WallSegment> divided(const std::vector<grains::WallSegment> &sides,
                                             const geometry::BoundaryPart           &part)
    {
      std::vector<grains::WallSegment> result;
      for (const auto &side : sides)
        {
          if (side.name != part.side_name)
            {
              result.push_back(side);
              continue;
            }
          for (const auto &piece : geometry::divide_face({part}, part.side, side.a, side.b))
            {
              result.push_back(side);
              for (unsigned int d = 0; d < 2; ++d)
                {
                  result.back().a[d] = side.a[d] + piece.begin * (side.b[d] - side.a[d]);
                  result.back().b[d] = side.a[d] + piece.end * (side.b[d] - side.a[d]);
                }
              if (piece.id == part.id)
                result.back().name = part.name;
            }
        }
      return result;
    }
  } // namespace


  template <int dim>
  Domain<dim>::Domain()
    : communicator(MPI_COMM_SELF)
  {
    for (unsigned int d = 0; d < dim; ++d)
      upper_corner[d] = 1.;
  }


  template <int dim>
  Domain<dim>::~Domain() = default;


  template <int dim>
  void Domain<dim>::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Domain");
    prm.add_parameter(
      "Lower left corner",
      lower_corner,
      "The rectangle's lower left corner [m]: x, y. Its boundaries are named left, right, bottom and top.");
    prm.add_parameter("Upper right corner", upper_corner, "The rectangle's upper right corner [m]: x, y.");
    prm.add_parameter("Mesh file",
                      mesh_file,
                      "A mesh by gmsh (.msh, ASCII, format 4.1 or 2.2) instead of the rectangle, of triangles or of "
                      "quadrilaterals; lengths in m, path relative to the parameter file. Its physical curves name the "
                      "boundaries, and every side must be in one. Triangles are used as they are; quadrilaterals are "
                      "the coarsest cells of the adaptive mesh.");
    prm.add_parameter(
      "Coarse cell size",
      coarse_size,
      "Largest cell of the rectangle's mesh [m]. 0: from the refinement criteria, which measure in grain "
      "diameters. Needed without grains.",
      Patterns::Double(0.));
    prm.add_parameter("Max diameters across",
                      max_diameters,
                      "A domain that is more mean grain diameters wide or high than this, and all but empty of grains, "
                      "is taken for one "
                      "in millimetres, and refused.",
                      Patterns::Double(1.));
    prm.add_parameter(
      "Named parts",
      parts_text,
      "Parts of sides with names of their own, as `name = side: low < x < high; ...` [m]; also `x < high`, "
      "`x > low`, and y. For instance `inlet = bottom: 0.014 < x < 0.016`. The rest of the side keeps its "
      "name. A velocity given on a part brings its exact flux, however large the cells; other conditions "
      "hold at the nodes of the mesh that lie in the part. For grains a part is still a wall of its side, "
      "unless it is named in `Open to grains`.");
    prm.add_parameter(
      "Open to grains",
      open_to_grains,
      "Names of the boundaries that are no walls for the grains, separated by commas. A grain whose centre "
      "crosses one of them is taken out and counted, and the run goes on without it.");
    prm.add_parameter("Periodic directions",
                      periodic_directions,
                      "Directions in which the rectangle repeats itself, for fluid and grains: what leaves it at one "
                      "side comes in at the other. In x there are then no boundaries left and right, in y none bottom "
                      "and top.",
                      Patterns::MultipleSelection("x|y"));
    prm.leave_subsection();
  }


  template <int dim>
  grains::Periodicity Domain<dim>::periodicity() const
  {
    grains::Periodicity result;
    for (const auto &direction : Utilities::split_string_list(periodic_directions))
      {
        const unsigned int d = direction == "x" ? 0 : 1;
        result.lower[d]      = lower_corner[d];
        result.length[d]     = upper_corner[d] - lower_corner[d];
      }
    return result;
  }


  template <int dim>
  void Domain<dim>::initialize(const MPI_Comm mpi_communicator, const std::string &directory)
  {
    communicator = mpi_communicator;
    ids.clear();
    wall_segments.clear();
    triangles = false;
    if (is_rectangle())
      {
        for (unsigned int d = 0; d < dim; ++d)
          check_user(std::isfinite(lower_corner[d]) && std::isfinite(upper_corner[d]) &&
                       lower_corner[d] < upper_corner[d],
                     "Domain: the upper right corner must be above and to the right of the lower left one; in " +
                       std::string(d == 0 ? "x" : "y") + " they are at " + in_digits(lower_corner[d]) + " and " +
                       in_digits(upper_corner[d]) + " m.");
        using namespace magnitudes;
        for (unsigned int d = 0; d < dim; ++d)
          check_user(std::abs(lower_corner[d]) <= largest_length && std::abs(upper_corner[d]) <= largest_length &&
                       upper_corner[d] - lower_corner[d] >= smallest_length,
                     std::string("Domain: in ") + (d == 0 ? "x" : "y") + " it reaches from " +
                       in_digits(lower_corner[d]) + " to " + in_digits(upper_corner[d]) +
                       " m; expected corners no farther than " + in_digits(largest_length) +
                       " m from 0, and sides of at least " + in_digits(smallest_length) + " m.");
        ids             = {{"left", 0}, {"right", 1}, {"bottom", 2}, {"top", 3}}; // deal.II's colours of a rectangle
        const double x0 = lower_corner[0], y0 = lower_corner[1], x1 = upper_corner[0], y1 = upper_corner[1];
        wall_segments = {{{{x0, y1}}, {{x0, y0}}, {{0., 0.}}, "left"},
                         {{{x1, y0}}, {{x1, y1}}, {{0., 0.}}, "right"},
                         {{{x0, y0}}, {{x1, y0}}, {{0., 0.}}, "bottom"},
                         {{{x1, y1}}, {{x0, y1}}, {{0., 0.}}, "top"}};
      }
    else
      read_mesh_file(directory);

    const grains::Periodicity box = periodicity();
    check_user(!box.any() || is_rectangle(),
               "Domain/Periodic directions: only a rectangle can be periodic, no mesh file.");
    for (unsigned int d = 0; d < dim; ++d)
      if (box.length[d] > 0.)
        for (const std::string name : {d == 0 ? "left" : "bottom", d == 0 ? "right" : "top"})
          {
            ids.erase(name);
            wall_segments.erase(std::remove_if(wall_segments.begin(),
                                               wall_segments.end(),
                                               [&](const auto &wall) { return wall.name == name; }),
                                wall_segments.end());
          }

    all_sides = wall_segments;
    name_parts();
    for (const auto &part : named_parts)
      all_sides = divided(all_sides, part);

    open_names = Utilities::split_string_list(open_to_grains);
    for (const auto &name : open_names)
      {
        std::string known;
        for (const auto &[other, id] : ids)
          known += (known.empty() ? "" : ", ") + other;
        check_user(ids.count(name) == 1,
                   "Domain/Open to grains: there is no boundary named '" + name +
                     "'. The domain's boundaries are: " + known + ".");
        const auto part =
          std::find_if(named_parts.begin(), named_parts.end(), [&](const auto &p) { return p.name == name; });
        if (part != named_parts.end())
          wall_segments = divided(wall_segments, *part);
        wall_segments.erase(std::remove_if(wall_segments.begin(),
                                           wall_segments.end(),
                                           [&](const auto &wall) { return wall.name == name; }),
                            wall_segments.end());
      }
  }


  template <int dim>
  void Domain<dim>::name_parts()
  {
    std::vector<BoundarySide> sides;
    for (const auto &wall : wall_segments)
      sides.push_back({wall.a, wall.b, ids.at(wall.name)});
    named_parts = parse_boundary_parts(parts_text, sides, ids);
  }


  template <int dim>
  std::string Domain<dim>::left_through(const std::array<double, 2> &point) const
  {
    const auto &open = open_names;
    if (open.empty())
      return "";
    const double x = point[0], y = point[1];
    if (contains(x, y))
      return "";
    std::string name;
    double      nearest = std::numeric_limits<double>::max();
    for (const bool is_open : {true, false}) // at a corner, through the open side
      for (const auto &s : all_sides)
        if ((std::find(open.begin(), open.end(), s.name) != open.end()) == is_open)
          {
            const double distance = grains::distance_to(s, x, y);
            if (distance < (1. - 1e-9) * nearest)
              {
                nearest = distance;
                name    = s.name;
              }
          }
    return name;
  }


  template <int dim>
  bool Domain<dim>::contains(const double x, const double y) const
  {
    const double tolerance = 1e-12 * lower_corner.distance(upper_corner);
    if (is_rectangle())
      {
        const auto box = periodicity();
        return (box.length[0] > 0. || (x >= lower_corner[0] && x <= upper_corner[0])) &&
               (box.length[1] > 0. || (y >= lower_corner[1] && y <= upper_corner[1]));
      }
    bool inside = false;
    for (const grains::WallSegment &side : all_sides)
      {
        if (grains::distance_to(side, x, y) <= tolerance)
          return true;
        // a ray to the right crosses the boundary an odd number of times; both faces of a crack count
        if (const auto at = grains::crossing(side, y); at && *at > x)
          inside = !inside;
      }
    return inside;
  }


  template <int dim>
  void Domain<dim>::read_mesh_file(const std::string &directory)
  {
    const std::filesystem::path path(mesh_file);
    mesh_path =
      path.is_absolute() || directory.empty() ? path.string() : (std::filesystem::path(directory) / path).string();

    // one rank reads, all know whether it could
    std::vector<std::string> content(2);
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::error_code    ignored;
        std::ifstream      file(mesh_path, std::ios::binary);
        std::ostringstream buffer;
        if (!std::filesystem::exists(mesh_path, ignored))
          content[1] = "does not exist.";
        else if (std::filesystem::is_directory(mesh_path, ignored) || !file)
          content[1] = "cannot be read.";
        else if (!(buffer << file.rdbuf()))
          content[1] = "is empty.";
        content[0] = buffer.str();
        note_input(mesh_path);
      }
    content = Utilities::MPI::broadcast(communicator, content);
    check_user(content[1].empty(), "Domain/Mesh file: '" + mesh_path + "' " + content[1]);
    mesh_text = content[0];
    strip_byte_order_mark(mesh_text, "Domain/Mesh file: '" + mesh_path + "'");

    GmshFile file = read_gmsh_file(mesh_text, mesh_path);
    make_valid(file, mesh_path);
    triangles = file.has_triangles();
    std::map<types::boundary_id, std::string> names;
    for (const auto &[name, id] : file.boundary_names)
      {
        ids[name] = id;
        names[id] = name;
      }

    Triangulation<dim> serial;
    make_from(serial, file, mesh_path);
    std::vector<Side> sides;
    for (const auto &cell : serial.active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary())
          {
            const auto face = cell->face(f);
            if (names.count(face->boundary_id()) == 0)
              {
                std::ostringstream where;
                where << "(" << face->center() << ")";
                throw UserError("Mesh file '" + mesh_path + "': the side of the boundary at " + where.str() +
                                " is in no named physical curve.");
              }
            sides.push_back({face->vertex_index(0), face->vertex_index(1), face->boundary_id()});
          }
    for (const auto &[id, name] : names)
      check_user(std::any_of(sides.begin(), sides.end(), [id = id](const Side &side) { return side.id == id; }),
                 "Mesh file '" + mesh_path + "': the physical curve '" + name +
                   "' is not on the boundary of the mesh.");

    lower_corner = upper_corner = serial.begin_active()->vertex(0);
    for (const Side &side : sides)
      for (const unsigned int v : {side.a, side.b})
        for (unsigned int d = 0; d < dim; ++d)
          {
            lower_corner[d] = std::min(lower_corner[d], serial.get_vertices()[v][d]);
            upper_corner[d] = std::max(upper_corner[d], serial.get_vertices()[v][d]);
          }

    std::vector<types::boundary_id> side_ids;
    const auto                      straight = straight_sides(serial, sides, side_ids);
    for (std::size_t s = 0; s < straight.size(); ++s)
      wall_segments.push_back({{{straight[s][0][0], straight[s][0][1]}},
                               {{straight[s][1][0], straight[s][1][1]}},
                               {{0., 0.}},
                               names.at(side_ids[s])});
  }


  template <int dim>
  std::array<double, dim> Domain<dim>::n_cells_of_rectangle(const double cell_size) const
  {
    check_user(cell_size > 0.,
               "Domain: without grains, 'Coarse cell size' must say how large the cells of the mesh are.");
    double                  side = std::numeric_limits<double>::max();
    std::array<double, dim> n;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double length = upper_corner[d] - lower_corner[d];
        side                = std::min(side, length / std::max(1., std::ceil(length / cell_size * (1. - 1e-10))));
      }
    for (unsigned int d = 0; d < dim; ++d)
      // halves are rounded up, whatever the last digits of a shifted domain say
      n[d] = std::max(1., std::round((upper_corner[d] - lower_corner[d]) / side + 1e-9));
    return n;
  }


  template <int dim>
  void Domain<dim>::make_rectangle(Triangulation<dim> &triangulation, const double cell_size) const
  {
    const std::array<double, dim> n = n_cells_of_rectangle(cell_size);
    for (unsigned int d = 0; d < dim; ++d)
      check_user(n[d] < 1e5,
                 "Domain: cells of " + in_digits((upper_corner[d] - lower_corner[d]) / n[d]) +
                   " m are too small for a domain of " + in_digits(upper_corner[d] - lower_corner[d]) + " m.");
    GridGenerator::subdivided_hyper_rectangle(
      triangulation, std::vector<unsigned int>(n.begin(), n.end()), lower_corner, upper_corner, true);
  }


  template <int dim>
  std::unique_ptr<Triangulation<dim>>
  Domain<dim>::make_triangulation(const double                            cell_size,
                                  const bool                              never_refines,
                                  const CellWeights                      &weights,
                                  const std::vector<types::subdomain_id> &owners) const
  {
    const auto box  = periodicity();
    const auto make = [&](Triangulation<dim> &triangulation) {
      if (is_rectangle())
        make_rectangle(triangulation, cell_size);
      else
        {
          GmshFile file = read_gmsh_file(mesh_text, mesh_path);
          make_valid(file, mesh_path);
          make_from(triangulation, file, mesh_path);
        }
    };
    if (triangles || (never_refines && is_rectangle() && !box.any()))
      {
        using Shared    = parallel::shared::Triangulation<dim>;
        auto result     = std::make_unique<Shared>(communicator, Shared::none, true, Shared::partition_custom_signal);
        auto connection = result->signals.create.connect([&] {
          if (owners.size() != result->n_active_cells())
            partition_by_bisection(*result, weights);
          else
            for (const auto &cell : result->active_cell_iterators())
              cell->set_subdomain_id(owners[cell->active_cell_index()]);
        });
        make(*result);
        connection.disconnect(); // it knows the weights, which may go
        check_partition(*result);
        return result;
      }

    auto result = std::make_unique<parallel::distributed::Triangulation<dim>>(communicator);
    make(*result);
    std::vector<GridTools::PeriodicFacePair<typename Triangulation<dim>::cell_iterator>> pairs;
    for (unsigned int d = 0; d < dim; ++d)
      if (box.length[d] > 0.)
        GridTools::collect_periodic_faces(*result, 2 * d, 2 * d + 1, d, pairs);
    if (!pairs.empty())
      result->add_periodicity(pairs);
    return result;
  }


  template <int dim>
  void Domain<dim>::check_partition(const Triangulation<dim> &triangulation)
  {
    const auto n_ranks = Utilities::MPI::n_mpi_processes(triangulation.get_communicator());
    const auto n_cells = triangulation.n_global_active_cells();
    check_user(n_cells >= n_ranks,
               "The fluid's mesh has " + std::to_string(n_cells) + " cells, too few for " + std::to_string(n_ranks) +
                 " MPI ranks: start fewer.");
  }


  template class Domain<2>;
} // namespace alluvium::mesh
