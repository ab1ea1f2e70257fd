#include <alluvium/grains/grain_store.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/mpi.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/mapping_cartesian.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/particles/particle_handler.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace alluvium::grains
{
  using namespace dealii;

  namespace
  {
    /** The particles' properties, in their order. */
    constexpr std::array<std::vector<double> GrainArrays::*, 10> properties = {{&GrainArrays::radius,
                                                                                &GrainArrays::fluid_radius,
                                                                                &GrainArrays::mass,
                                                                                &GrainArrays::vx,
                                                                                &GrainArrays::vy,
                                                                                &GrainArrays::omega,
                                                                                &GrainArrays::fcx,
                                                                                &GrainArrays::fcy,
                                                                                &GrainArrays::x0,
                                                                                &GrainArrays::y0}};
    enum Property
    {
      radius,
      fluid_radius,
      mass,
      vx,
      vy,
      omega,
      fcx,
      fcy,
      x0,
      y0
    };

    // a grain on the wire: id, x, y, properties
    constexpr unsigned int n_wire = 3 + properties.size();

    /** Grains as points for ParaView: Particles::DataOut writes properties only, and the displacement is none. */
    class GrainOutput : public DataOutInterface<0, 2>
    {
    public:
      explicit GrainOutput(const Particles::ParticleHandler<2> &particles)
      {
        for (const auto &particle : particles)
          {
            const auto               p = particle.get_properties();
            const Point<2>           x = particle.get_location();
            DataOutBase::Patch<0, 2> patch;
            patch.vertices[0] = x;
            patch.patch_index = patches.size();
            patch.data.reinit(names.size(), 1);
            const std::array<double, 9> values = {{double(particle.get_id()),
                                                   p[radius],
                                                   x[0] - p[x0],
                                                   x[1] - p[y0],
                                                   p[vx],
                                                   p[vy],
                                                   p[omega],
                                                   p[fcx],
                                                   p[fcy]}};
            for (unsigned int i = 0; i < values.size(); ++i)
              patch.data(i, 0) = values[i];
            patches.push_back(patch);
          }
      }

    protected:
      const std::vector<DataOutBase::Patch<0, 2>> &get_patches() const override { return patches; }
      std::vector<std::string>                     get_dataset_names() const override { return names; }
      std::vector<
        std::tuple<unsigned int, unsigned int, std::string, DataComponentInterpretation::DataComponentInterpretation>>
      get_nonscalar_data_ranges() const override
      {
        const auto vector = DataComponentInterpretation::component_is_part_of_vector;
        return {std::make_tuple(2u, 3u, "displacement", vector),
                std::make_tuple(4u, 5u, "velocity", vector),
                std::make_tuple(7u, 8u, "contact_force", vector)};
      }

    private:
      std::vector<DataOutBase::Patch<0, 2>> patches;
      const std::vector<std::string>        names = {"id",
                                                     "radius",
                                                     "displacement",
                                                     "displacement",
                                                     "velocity",
                                                     "velocity",
                                                     "angular_velocity",
                                                     "contact_force",
                                                     "contact_force"};
    };
  } // namespace


  class GrainStore::Implementation
  {
  public:
    using Cell = Triangulation<2>::active_cell_iterator;

    explicit Implementation(const MPI_Comm communicator)
      : communicator(communicator)
    {}

    void make_grid(const GrainArrays           &grains,
                   const std::array<double, 2> &box_lower,
                   const std::array<double, 2> &box_upper,
                   const double                 skin)
    {
      double largest = 0.;
      for (const double r : grains.radius)
        largest = std::max(largest, 2. * r);
      double width = largest + skin;
      if (!(width > 0.)) // no grains
        width = std::max(box_upper[0] - box_lower[0], box_upper[1] - box_lower[1]);

      std::array<double, 2> n;
      for (unsigned int d = 0; d < 2; ++d)
        {
          lower[d] = box_lower[d] - width;
          upper[d] = box_upper[d] + width;
        }
      // few grains in a wide box get few, large cells: the grid's size goes with the grains, not with the box; and many
      // share them, since p4est's cells are dear
      const double most_cells = 4096. + 0.125 * grains.n();
      const auto count = [&](const unsigned int d) { return std::max(1., std::floor((upper[d] - lower[d]) / width)); };
      while (count(0) * count(1) > most_cells)
        width *= 1.2;
      for (unsigned int d = 0; d < 2; ++d)
        n[d] = count(d);
      // trees of the forest are dear, its refinement is cheap; a few cells more or less in a row do not matter
      unsigned int n_levels = 0;
      while (std::min(n[0], n[1]) / (2 << n_levels) >= 8.)
        ++n_levels;
      std::vector<unsigned int> n_trees(2);
      for (unsigned int d = 0; d < 2; ++d)
        {
          n_trees[d] = static_cast<unsigned int>(n[d]) >> n_levels;
          n_cells[d] = n_trees[d] << n_levels;
          size[d]    = (upper[d] - lower[d]) / n_cells[d];
        }
      particles.reset();
      grid.clear();
      GridGenerator::subdivided_hyper_rectangle(grid, n_trees, lower, upper);
      grid.refine_global(n_levels);
      list_cells();
      particles = std::make_unique<Particles::ParticleHandler<2>>(grid, mapping, properties.size());
    }

    /** Number of the grid's cell around (x, y). */
    std::size_t cell_number(const double x, const double y) const
    {
      const auto index = [&](const double value, const unsigned int d) {
        return static_cast<std::size_t>(std::clamp(std::floor((value - lower[d]) / size[d]), 0., n_cells[d] - 1.));
      };
      return index(y, 1) * n_cells[0] + index(x, 0);
    }

    /** Are the cells around @p a and @p b the same or next to each other, sides or corners? */
    bool are_neighbors(const Point<2> &a, const Point<2> &b) const
    {
      const std::size_t m = cell_number(a[0], a[1]), n = cell_number(b[0], b[1]);
      const auto        near = [](const std::size_t i, const std::size_t j) { return i <= j + 1 && j <= i + 1; };
      return near(m % n_cells[0], n % n_cells[0]) && near(m / n_cells[0], n / n_cells[0]);
    }

    void list_cells()
    {
      my_cells.assign(std::size_t(n_cells[0]) * n_cells[1], Cell());
      for (const auto &cell : grid.active_cell_iterators())
        if (cell->is_locally_owned())
          my_cells[cell_number(cell->center()[0], cell->center()[1])] = cell;
    }

    /** Throws on all ranks, which have the same arrays. */
    void check_positions(const GrainArrays &grains) const
    {
      for (std::size_t i = 0; i < grains.n(); ++i)
        {
          const double x = grains.x[i], y = grains.y[i];
          const bool   finite = std::isfinite(x) && std::isfinite(y);
          if (!(x >= lower[0] && x <= upper[0] && y >= lower[1] && y <= upper[1]) && !(may_leave && finite))
            {
              std::ostringstream text;
              text << "Grain " << grains.id[i] << " left the domain: it is at (" << x << ", " << y
                   << ") m, and the grains' grid reaches from (" << lower << ") to (" << upper
                   << ") m. Grains need walls around them, and a time step in which they cannot jump over them.";
              throw UserError(text.str());
            }
        }
    }

    /** Put grain number @p i of @p grains into its cell if this rank owns that. */
    void insert(const GrainArrays &grains, const std::size_t i)
    {
      const Cell &cell = my_cells[cell_number(grains.x[i], grains.y[i])];
      if (cell == Cell())
        return;
      const Point<2> x(grains.x[i], grains.y[i]), corner = cell->vertex(0);
      Point<2>       reference;
      for (unsigned int d = 0; d < 2; ++d)
        reference[d] = std::clamp((x[d] - corner[d]) / (cell->vertex(3)[d] - corner[d]), 0., 1.);
      std::array<double, properties.size()> values;
      for (unsigned int p = 0; p < properties.size(); ++p)
        values[p] = (grains.*properties[p])[i];
      particles->insert_particle(x, reference, grains.id[i], cell, make_array_view(values.begin(), values.end()));
    }

    void insert_all(const GrainArrays &grains)
    {
      check_positions(grains);
      ids = grains.id;
      number_of_id.assign(ids.empty() ? 0 : ids.back() + 1, 0);
      for (std::size_t i = 0; i < ids.size(); ++i)
        number_of_id[ids[i]] = i;
      particles->clear_particles();
      for (std::size_t i = 0; i < grains.n(); ++i)
        insert(grains, i);
      particles->update_cached_numbers();
      n_grains = grains.n();
      AssertThrow(particles->n_global_particles() == n_grains, ExcInternalError());
    }

    /** Insert those of @p grains that no rank has. */
    void rescue(const GrainArrays &grains)
    {
      std::vector<unsigned int> found(n_grains, 0);
      for (const auto &particle : *particles)
        ++found[number_of_id[particle.get_id()]];
      std::vector<unsigned int> found_anywhere(n_grains);
      Utilities::MPI::sum(found, communicator, found_anywhere);
      for (std::size_t i = 0; i < n_grains; ++i)
        if (found_anywhere[i] == 0)
          {
            insert(grains, i);
            ++n_rescued;
          }
      particles->update_cached_numbers();
      if (particles->n_global_particles() != n_grains)
        throw std::runtime_error("There are " + std::to_string(particles->n_global_particles()) +
                                 " grains instead of " + std::to_string(n_grains) +
                                 ": grains were lost or doubled between ranks.");
    }

    MPI_Comm                                       communicator;
    Point<2>                                       lower, upper; // of the grid
    std::array<unsigned int, 2>                    n_cells = {{0, 0}};
    std::array<double, 2>                          size    = {{0., 0.}}; // of a cell
    std::vector<Cell>                              my_cells; // by number; invalid where another rank owns it
    std::size_t                                    n_grains = 0, n_rescued = 0;
    std::vector<GrainId>                           ids; // of all grains, in rising order
    std::vector<std::uint32_t>                     number_of_id;
    bool                                           may_leave = false;
    MappingCartesian<2>                            mapping;
    parallel::distributed::Triangulation<2>        grid{communicator};
    std::unique_ptr<Particles::ParticleHandler<2>> particles;
  };


  GrainStore::GrainStore(const MPI_Comm communicator)
    : implementation(std::make_unique<Implementation>(communicator))
  {}


  GrainStore::~GrainStore() = default;


  void GrainStore::initialize(const GrainArrays           &grains,
                              const std::array<double, 2> &lower,
                              const std::array<double, 2> &upper,
                              const double                 skin)
  {
    for (std::size_t i = 1; i < grains.n(); ++i)
      AssertThrow(grains.id[i - 1] < grains.id[i], ExcMessage("Grains must be sorted by their ids."));
    implementation->make_grid(grains, lower, upper, skin);
    implementation->insert_all(grains);
    implementation->n_rescued = 0;
  }


  void GrainStore::let_leave(const bool yes)
  {
    implementation->may_leave = yes;
  }


  void GrainStore::replace(const GrainArrays &grains)
  {
    implementation->insert_all(grains);
  }


  std::size_t GrainStore::n_grains() const
  {
    return implementation->n_grains;
  }


  std::size_t GrainStore::n_local_grains() const
  {
    return implementation->particles ? implementation->particles->n_locally_owned_particles() : 0;
  }


  std::size_t GrainStore::n_rescued() const
  {
    return implementation->n_rescued;
  }


  GrainArrays GrainStore::gather() const
  {
    const Implementation &my = *implementation;
    std::vector<double>   mine;
    mine.reserve(n_wire * n_local_grains());
    if (my.particles)
      for (const auto &particle : *my.particles)
        {
          mine.push_back(particle.get_id());
          mine.push_back(particle.get_location()[0]);
          mine.push_back(particle.get_location()[1]);
          for (const double value : particle.get_properties())
            mine.push_back(value);
        }

    const auto       n_ranks = Utilities::MPI::n_mpi_processes(my.communicator);
    std::vector<int> counts(n_ranks), offsets(n_ranks, 0);
    const int        my_count = mine.size();
    MPI_Allgather(&my_count, 1, MPI_INT, counts.data(), 1, MPI_INT, my.communicator);
    std::partial_sum(counts.begin(), counts.end() - 1, offsets.begin() + 1);
    std::vector<double> all(offsets.back() + counts.back());
    MPI_Allgatherv(
      mine.data(), my_count, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, my.communicator);

    AssertThrow(all.size() == n_wire * my.n_grains, ExcInternalError());
    GrainArrays result;
    result.resize(my.n_grains);
    std::vector<bool> seen(my.n_grains, false);
    for (std::size_t k = 0; k < my.n_grains; ++k)
      {
        const double *grain = &all[n_wire * k];
        const auto    id    = static_cast<GrainId>(grain[0]);
        AssertThrow(id < my.number_of_id.size(), ExcInternalError());
        const std::size_t i = my.number_of_id[id];
        AssertThrow(i < my.n_grains && !seen[i], ExcInternalError());
        seen[i]      = true;
        result.id[i] = id;
        result.x[i]  = grain[1];
        result.y[i]  = grain[2];
        for (unsigned int p = 0; p < properties.size(); ++p)
          (result.*properties[p])[i] = grain[3 + p];
      }
    return result;
  }


  void GrainStore::scatter(const GrainArrays &grains)
  {
    Implementation &my = *implementation;
    AssertThrow(grains.n() == my.n_grains, ExcDimensionMismatch(grains.n(), my.n_grains));
    my.check_positions(grains);
    my.n_rescued = 0;
    if (!my.particles)
      return;
    // deal.II knows only the cells next to its own: who jumps farther is taken out here and put in again below
    std::vector<Particles::ParticleIterator<2>> far;
    for (auto particle = my.particles->begin(); particle != my.particles->end(); ++particle)
      {
        const auto i = my.number_of_id[particle->get_id()];
        if (!my.are_neighbors(particle->get_surrounding_cell()->center(), Point<2>(grains.x[i], grains.y[i])))
          {
            far.push_back(particle);
            continue;
          }
        particle->set_location(Point<2>(grains.x[i], grains.y[i]));
        const auto values = particle->get_properties();
        for (unsigned int p = 0; p < properties.size(); ++p)
          values[p] = (grains.*properties[p])[i];
      }
    my.particles->remove_particles(far);
    my.particles->sort_particles_into_subdomains_and_cells();
    my.particles->update_cached_numbers();
    if (my.particles->n_global_particles() != my.n_grains)
      my.rescue(grains);
  }


  void GrainStore::rebalance()
  {
    Implementation &my = *implementation;
    if (!my.particles)
      return;
    const GrainArrays         grains = gather();
    std::vector<unsigned int> n_in_cell(my.my_cells.size(), 0);
    for (std::size_t i = 0; i < grains.n(); ++i)
      ++n_in_cell[my.cell_number(grains.x[i], grains.y[i])];

    // the particles are put in anew, so nothing has to travel with the cells
    my.particles->clear_particles();
    const boost::signals2::scoped_connection connection =
      my.grid.signals.weight.connect([&](const auto &cell, const auto) -> unsigned int {
        return 1 + 10 * n_in_cell[my.cell_number(cell->center()[0], cell->center()[1])];
      });
    my.grid.repartition();
    my.list_cells();
    my.insert_all(grains);
  }


  void GrainStore::output(const std::function<void(DataOutInterface<0, 2> &)> &use) const
  {
    AssertThrow(implementation->particles, ExcNotInitialized());
    GrainOutput output(*implementation->particles);
    use(output);
  }


  void GrainStore::write_vtu(const std::string &file_name) const
  {
    output([&](DataOutInterface<0, 2> &data) {
      DataOutBase::VtkFlags flags;
      flags.compression_level = decltype(flags.compression_level)::best_speed;
      data.set_flags(flags);
      data.write_vtu_in_parallel(file_name, implementation->communicator);
    });
  }


  const Particles::ParticleHandler<2> &GrainStore::particles() const
  {
    AssertThrow(implementation->particles, ExcNotInitialized());
    return *implementation->particles;
  }
} // namespace alluvium::grains
