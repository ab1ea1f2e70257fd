#include <alluvium/mesh/domain.h>
#include <alluvium/refinement/adaptivity.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/tria_accessor.h>
#include <deal.II/grid/tria_iterator.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace alluvium::refinement
{
  using namespace dealii;

  namespace
  {
    template <typename Cell>
    double size_of(const Cell &cell)
    {
      return cell->diameter() / std::sqrt(double(Cell::AccessorType::dimension));
    }

    // sides of h and wishes of h differ by rounding
    constexpr double tolerance = 1. + 1e-6;
  } // namespace


  template <int dim>
  void Adaptivity<dim>::add_parameters(ParameterHandler &prm)
  {
    prm.enter_subsection("Mesh refinement");
    criteria.add_parameters(
      prm,
      "Criteria",
      "bed faces",
      "What decides how fine the fluid's mesh is; of several, separated by commas, the finest wins. Sizes "
      "are in mean grain diameters d.",
      true);
    prm.add_parameter("Coarsest cell size",
                      coarsest,
                      "No cell is larger, in mean grain diameters, whatever the criteria say.",
                      Patterns::Double(1e-3));
    prm.add_parameter("Finest cell size",
                      finest,
                      "No smaller size is asked for, in mean grain diameters, whatever the criteria say. (Cells are "
                      "halved until they are small enough, so they may end up smaller than asked by up to a factor 2.)",
                      Patterns::Double(1e-3));
    prm.add_parameter(
      "Interval",
      interval,
      "Adapt the mesh every so many time steps; 0: only at the start. A mesh of triangles is never adapted.",
      Patterns::Integer(0));
    prm.add_parameter("Max levels", max_levels, "How often a cell may be halved.", Patterns::Integer(0, 25));
    prm.add_parameter(
      "Max cells",
      max_cells,
      "With more cells the run does not start; reached later, cells are refined no further, with a warning.",
      Patterns::Double(1.));
    prm.add_parameter(
      "Margin",
      margin,
      "Four cells become one only if that one would be fine enough also this far around it, in its own sizes. It "
      "keeps the mesh from changing to and fro.",
      Patterns::Double(0.));
    prm.leave_subsection();
  }


  template <int dim>
  void Adaptivity<dim>::parse_parameters()
  {
    check_user(finest <= coarsest,
               "Mesh refinement: 'Finest cell size' = " + in_digits(finest) +
                 " is larger than 'Coarsest cell size' = " + in_digits(coarsest) + ", in mean grain diameters.");
    criteria.parse_parameters();
  }


  template <int dim>
  double Adaptivity<dim>::coarse_size(const RefinementContext &context) const
  {
    if (!(context.grain_diameter > 0.))
      return 0.;
    double result = coarsest * context.grain_diameter;
    for (const RefinementCriterion *criterion : criteria.all())
      result = std::min(result, std::max(criterion->coarsest_size(context), finest * context.grain_diameter));
    return result;
  }


  template <int dim>
  double
  Adaptivity<dim>::wanted_size(const mesh::Box &box, const RefinementContext &context, const Purpose purpose) const
  {
    double result = RefinementCriterion::no_wish;
    for (const RefinementCriterion *criterion : criteria.all())
      result = std::min(result, criterion->wanted_size(box, context, purpose));
    if (context.grain_diameter > 0.)
      result = std::clamp(result, finest * context.grain_diameter, std::max(coarsest, finest) * context.grain_diameter);
    return result;
  }


  template <int dim>
  bool Adaptivity<dim>::never_refines(const double size, const RefinementContext &context) const
  {
    const auto all = criteria.all();
    return interval == 0 && (!(context.grain_diameter > 0.) || size <= tolerance * coarse_size(context)) &&
           std::all_of(all.begin(), all.end(), [](const auto *criterion) { return criterion->is_uniform(); });
  }


  template <int dim>
  bool Adaptivity<dim>::due(const unsigned int step) const
  {
    return interval > 0 && step > 0 && step % interval == 0;
  }


  template <int dim>
  std::string Adaptivity<dim>::remark_on_limits(const RefinementContext &context) const
  {
    for (const RefinementCriterion *criterion : criteria.all())
      if (const double d = context.grain_diameter; d > 0. && tolerance * criterion->coarsest_size(context) < finest * d)
        return "Mesh refinement/Criteria ask for cells of " + in_digits(criterion->coarsest_size(context) / d) +
               " mean grain diameters, but 'Finest cell size' is " + in_digits(finest) + ": no smaller ones are made";
    return "";
  }


  template <int dim>
  void Adaptivity<dim>::check_until(const double end_time, const RefinementContext &context) const
  {
    for (RefinementCriterion *criterion : criteria.all())
      if (interval > 0)
        criterion->check_until(end_time, context);
  }


  template <int dim>
  bool Adaptivity<dim>::needs_fluid() const
  {
    for (const RefinementCriterion *criterion : criteria.all())
      if (criterion->needs_fluid())
        return true;
    return false;
  }


  template <int dim>
  void Adaptivity<dim>::check_mesh(const Triangulation<dim> &triangulation) const
  {
    check_user(
      interval == 0 || triangulation.all_reference_cells_are_hyper_cube(),
      "Mesh refinement/Interval: a mesh of triangles cannot be adapted (deal.II refines quadrilaterals in parallel). "
      "Set 'Interval = 0' to use the triangles as they are, or give a mesh of quadrilaterals "
      "(`Recombine Surface` in gmsh).");
  }


  template <int dim>
  double Adaptivity<dim>::expected_cells(std::vector<CellCorners<dim>> cells,
                                         double                        weight,
                                         const RefinementContext      &context) const
  {
    constexpr std::size_t most = 5000; // to look at, in a level
    for (RefinementCriterion *criterion : criteria.all())
      criterion->prepare(context);
    // of a list, evenly chosen ones that stand for the others, too
    const auto thin_out = [&](const std::vector<CellCorners<dim>> &all) {
      const std::size_t             n = std::min(all.size(), most);
      std::vector<CellCorners<dim>> some;
      for (std::size_t i = 0; i < n; ++i)
        some.push_back(all[static_cast<std::size_t>((i + 0.5) * all.size() / n)]);
      if (n > 0)
        weight *= double(all.size()) / n;
      return some;
    };
    double n = 0.;
    cells    = thin_out(cells);
    for (unsigned int level = 0; !cells.empty(); ++level)
      {
        std::vector<CellCorners<dim>> next;
        for (const CellCorners<dim> &cell : cells)
          {
            const double size = std::max(cell[0].distance(cell[3]), cell[1].distance(cell[2])) / std::sqrt(double(dim));
            mesh::Box    box;
            for (unsigned int d = 0; d < dim; ++d)
              {
                box.lower[d] = std::min({cell[0][d], cell[1][d], cell[2][d], cell[3][d]});
                box.upper[d] = std::max({cell[0][d], cell[1][d], cell[2][d], cell[3][d]});
              }
            if (level == max_levels || size <= tolerance * wanted_size(box, context, Purpose::refine))
              {
                n += weight;
                continue;
              }
            const auto at = [&](const double x, const double y) {
              return Point<dim>((1. - y) * ((1. - x) * cell[0] + x * cell[1]) + y * ((1. - x) * cell[2] + x * cell[3]));
            };
            for (const double y : {0., 0.5})
              for (const double x : {0., 0.5})
                next.push_back({{at(x, y), at(x + 0.5, y), at(x, y + 0.5), at(x + 0.5, y + 0.5)}});
          }
        cells = thin_out(next);
      }
    return n;
  }


  template <int dim>
  void Adaptivity<dim>::check_number(const double n_cells) const
  {
    constexpr double   error = 0.2;
    std::ostringstream text;
    text.precision(2);
    text << "Mesh refinement: the criteria ask for about " << n_cells;
    text.precision(6);
    text << " cells, and 'Max cells' is " << max_cells << ". Ask for larger cells or allow more.";
    check_user(n_cells <= (1. + error) * max_cells, text.str());
  }


  template <int dim>
  void Adaptivity<dim>::balance(Triangulation<dim> &triangulation, const mesh::CellWeights &weights)
  {
    if (dynamic_cast<parallel::distributed::Triangulation<dim> *>(&triangulation))
      triangulation.signals.weight.connect([&weights](const typename Triangulation<dim>::cell_iterator &cell,
                                                      const auto) { return weights.weight(mesh::box_of(cell)); });
  }


  template <int dim>
  AdaptationReport Adaptivity<dim>::make_initial_mesh(Triangulation<dim>      &triangulation,
                                                      const RefinementContext &context) const
  {
    check_mesh(triangulation);
    if (dynamic_cast<const parallel::distributed::Triangulation<dim> *>(&triangulation))
      {
        std::vector<CellCorners<dim>> cells;
        for (const auto &cell : triangulation.active_cell_iterators())
          if (cell->is_locally_owned())
            cells.push_back({{cell->vertex(0), cell->vertex(1), cell->vertex(2), cell->vertex(3)}});
        check_number(Utilities::MPI::sum(expected_cells(cells, 1., context), triangulation.get_communicator()));
      }
    const AdaptationReport report = run(triangulation, context, {}, {}, true);
    if (auto *distributed = dynamic_cast<parallel::distributed::Triangulation<dim> *>(&triangulation))
      distributed->repartition(); // also if nothing changed: the first partition knew of no weights
    mesh::Domain<dim>::check_partition(triangulation);
    return report;
  }


  template <int dim>
  AdaptationReport Adaptivity<dim>::adapt(Triangulation<dim>          &triangulation,
                                          const RefinementContext     &context,
                                          const std::function<void()> &before,
                                          const std::function<void()> &after) const
  {
    return run(triangulation, context, before, after, false);
  }


  template <int dim>
  AdaptationReport Adaptivity<dim>::run(Triangulation<dim>          &triangulation,
                                        const RefinementContext     &context,
                                        const std::function<void()> &before,
                                        const std::function<void()> &after,
                                        const bool                   initial) const
  {
    const MPI_Comm   communicator = triangulation.get_communicator();
    auto            *distributed  = dynamic_cast<parallel::distributed::Triangulation<dim> *>(&triangulation);
    AdaptationReport report;
    for (RefinementCriterion *criterion : criteria.all())
      criterion->prepare(context);

    // p4est may undo what was flagged, to keep neighbours within one level: only its own checksum (valid on rank 0)
    // tells
    const auto checksum = [&] { return Utilities::MPI::broadcast(communicator, distributed->get_checksum()); };
    auto       last     = distributed ? checksum() : 0;

    while (distributed && report.n_rounds < 2 * max_levels + 2)
      {
        unsigned long long n_refine = 0, n_coarsen = 0;
        bool               at_max_level = false;
        for (const auto &cell : triangulation.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              cell->clear_refine_flag();
              cell->clear_coarsen_flag();
              if (size_of(cell) > tolerance * wanted_size(mesh::box_of(cell), context, Purpose::refine))
                {
                  if (static_cast<unsigned int>(cell->level()) >= max_levels)
                    at_max_level = true;
                  else
                    {
                      cell->set_refine_flag();
                      ++n_refine;
                    }
                }
              else if (cell->level() > 0)
                {
                  const auto parent = cell->parent();
                  if (static_cast<unsigned int>(cell->level()) > max_levels ||
                      size_of(parent) <=
                        tolerance * wanted_size(mesh::box_of(parent, margin), context, Purpose::coarsen))
                    {
                      cell->set_coarsen_flag();
                      ++n_coarsen;
                    }
                }
            }
        n_refine  = Utilities::MPI::sum(n_refine, communicator);
        n_coarsen = Utilities::MPI::sum(n_coarsen, communicator);
        if (Utilities::MPI::max(int(at_max_level), communicator) == 1)
          report.limited = true;

        const double n_expected = double(triangulation.n_global_active_cells()) + 3. * n_refine - 0.75 * n_coarsen;
        if (n_refine > 0 && n_expected > max_cells)
          {
            std::ostringstream text;
            text << "Mesh refinement: the criteria ask for more than " << n_expected << " cells, and 'Max cells' is "
                 << max_cells << ". Ask for larger cells or allow more.";
            check_user(!initial, text.str());
            report.limited = true;
            n_refine       = 0;
            for (const auto &cell : triangulation.active_cell_iterators())
              cell->clear_refine_flag();
          }

        triangulation.prepare_coarsening_and_refinement();
        double flagged = 0., area = 0.;
        for (const auto &cell : triangulation.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              area += cell->measure();
              if (cell->refine_flag_set() || cell->coarsen_flag_set())
                flagged += cell->measure();
            }
        flagged = Utilities::MPI::sum(flagged, communicator);
        if (flagged == 0.)
          break;
        report.share = std::min(1., report.share + flagged / Utilities::MPI::sum(area, communicator));

        if (before)
          before();
        triangulation.execute_coarsening_and_refinement();
        if (after)
          after();
        ++report.n_rounds;
        const auto now = checksum();
        if (now == last)
          break;
        last           = now;
        report.changed = true;
      }

    double smallest = std::numeric_limits<double>::max(), largest = 0.;
    int    too_large = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const double size = size_of(cell);
          smallest          = std::min(smallest, size);
          largest           = std::max(largest, size);
          if (size > tolerance * wanted_size(mesh::box_of(cell), context, Purpose::refine))
            too_large = 1;
        }
    report.n_cells   = triangulation.n_global_active_cells();
    report.smallest  = Utilities::MPI::min(smallest, communicator);
    report.largest   = Utilities::MPI::max(largest, communicator);
    report.satisfied = Utilities::MPI::max(too_large, communicator) == 0;
    return report;
  }


  template class Adaptivity<2>;
} // namespace alluvium::refinement
