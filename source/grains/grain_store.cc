#include <alluvium/grains/grain_columns.h>
#include <alluvium/grains/grain_store.h>
#include <alluvium/utilities/divergence.h>
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
    /** The columns that are the particles' properties: all but the position. */
    constexpr unsigned int n_properties = n_grain_numbers - 2;

    template <typename Grains, typename Function>
    void for_each_property(Grains &grains, const Function &use)
    {
      unsigned int p = 0;
      for_each_column(grains, [&](auto &values, const GrainColumn &column) {
        if (&values != &grains.position[0] && &values != &grains.position[1])
          use(values, column, p++);
      });
    }

    /** Grains as points for ParaView: Particles::DataOut writes properties only, and the displacement is none. */
    class GrainOutput : public DataOutInterface<0, 2>
    {
    public:
      GrainOutput(const Particles::ParticleHandler<2> &particles,
                  const GrainArrays                   &grains,
                  const std::vector<std::uint32_t>    &number_of_id)
      {
        names = {"id", "displacement", "displacement"};
        vectors.emplace_back(1u, 2u, "displacement", DataComponentInterpretation::component_is_part_of_vector);
        std::vector<const std::vector<double> *> columns;
        for (const GrainColumn &column : grain_columns)
          if (column.in_pictures)
            {
              if (column.n_components > 1)
                vectors.emplace_back(names.size(),
                                     names.size() + column.n_components - 1,
                                     column.name,
                                     DataComponentInterpretation::component_is_part_of_vector);
              for (unsigned int c = 0; c < column.n_components; ++c)
                {
                  names.emplace_back(column.name);
                  columns.push_back(&column.values(grains, c));
                }
            }
        for (const auto &particle : particles)
          {
            const std::uint32_t      i = number_of_id[particle.get_id()];
            DataOutBase::Patch<0, 2> patch;
            patch.vertices[0] = particle.get_location();
            patch.patch_index = patches.size();
            patch.data.reinit(names.size(), 1);
            patch.data(0, 0) = particle.get_id();
            for (unsigned int d = 0; d < 2; ++d)
              patch.data(1 + d, 0) = grains.position[d][i] - grains.initial_position[d][i];
            for (unsigned int k = 0; k < columns.size(); ++k)
              patch.data(3 + k, 0) = (*columns[k])[i];
            patches.push_back(patch);
          }
      }

    protected:
      using Vector =
        std::tuple<unsigned int, unsigned int, std::string, DataComponentInterpretation::DataComponentInterpretation>;

      const std::vector<DataOutBase::Patch<0, 2>> &get_patches() const override { return patches; }
      std::vector<std::string>                     get_dataset_names() const override { return names; }
      std::vector<Vector>                          get_nonscalar_data_ranges() const override { return vectors; }

    private:
      std::vector<DataOutBase::Patch<0, 2>> patches;
      std::vector<std::string>              names;
      std::vector<Vector>                   vectors;
    };
  } // namespace


  class GrainStore::Implementation
  {
  public:
    using Cell = Triangulation<2>::active_cell_iterator;

    explicit Implementation(const MPI_Comm communicator)
      : communicator(communicator)
    {}

    /** Choose the grid; its cells are made when particles are first asked for. */
    void choose_grid(const std::array<double, 2> &box_lower, const std::array<double, 2> &box_upper, const double skin)
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
      // share them, since p4est's cells are expensive
      const double most_cells = 4096. + 0.125 * grains.n();
      const auto count = [&](const unsigned int d) { return std::max(1., std::floor((upper[d] - lower[d]) / width)); };
      while (count(0) * count(1) > most_cells)
        width *= 1.2;
      for (unsigned int d = 0; d < 2; ++d)
        n[d] = count(d);
      // trees of the forest are expensive, its refinement is cheap; a few cells more or less in a row do not matter
      n_levels = 0;
      while (std::min(n[0], n[1]) / (2 << n_levels) >= 8.)
        ++n_levels;
      for (unsigned int d = 0; d < 2; ++d)
        {
          n_trees[d] = static_cast<unsigned int>(n[d]) >> n_levels;
          n_cells[d] = n_trees[d] << n_levels;
          size[d]    = (upper[d] - lower[d]) / n_cells[d];
        }
      particles.reset();
    }

    void make_grid()
    {
      grid.clear();
      GridGenerator::subdivided_hyper_rectangle(grid, n_trees, lower, upper);
      grid.refine_global(n_levels);
      my_cells.assign(std::size_t(n_cells[0]) * n_cells[1], Cell());
      for (const auto &cell : grid.active_cell_iterators())
        if (cell->is_locally_owned())
          my_cells[cell_number(cell->center()[0], cell->center()[1])] = cell;
      particles = std::make_unique<Particles::ParticleHandler<2>>(grid, mapping, n_properties);
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

    /**
     * Throws, on all ranks, which have the same arrays, if a grain is not in the grid: a Divergence if it can have got
     * there in one step of @p dt [s], else a UserError.
     */
    void check_positions(const double dt) const
    {
      for (std::size_t i = 0; i < grains.n(); ++i)
        {
          const double x = grains.position[0][i], y = grains.position[1][i];
          const bool   finite = std::isfinite(x) && std::isfinite(y);
          if (!(x >= lower[0] && x <= upper[0] && y >= lower[1] && y <= upper[1]) && !(may_leave && finite))
            {
              std::ostringstream text;
              text << "Grain " << grains.id[i] << " left the domain: it is at (" << x << ", " << y
                   << ") m, and the grains' grid reaches from (" << lower << ") to (" << upper << ") m. ";
              const double speed = std::hypot(grains.velocity[0][i], grains.velocity[1][i]);
              if (!(dt * speed < grains.radius[i]))
                throw Divergence(text.str() + "It has jumped over what should have kept it.");
              throw UserError(text.str() + "Nothing keeps it: grains need walls around them. See Grains/Extra walls, "
                                           "Grains/Motion of walls, and Domain/Open to grains, where they may leave.");
            }
        }
    }

    Point<2> place(const std::size_t i) const { return {grains.position[0][i], grains.position[1][i]}; }

    /** Put grain number @p i into its cell if this rank owns that. */
    void insert(const std::size_t i)
    {
      const Cell &cell = my_cells[cell_number(grains.position[0][i], grains.position[1][i])];
      if (cell == Cell())
        return;
      const Point<2> x = place(i), corner = cell->vertex(0);
      Point<2>       reference;
      for (unsigned int d = 0; d < 2; ++d)
        reference[d] = std::clamp((x[d] - corner[d]) / (cell->vertex(3)[d] - corner[d]), 0., 1.);
      std::array<double, n_properties> values;
      for_each_property(grains,
                        [&](const auto &column, const GrainColumn &, const unsigned int p) { values[p] = column[i]; });
      particles->insert_particle(x, reference, grains.id[i], cell, make_array_view(values.begin(), values.end()));
    }

    void insert_all()
    {
      ids = grains.id;
      number_of_id.assign(ids.empty() ? 0 : ids.back() + 1, 0);
      for (std::size_t i = 0; i < ids.size(); ++i)
        number_of_id[ids[i]] = i;
      particles->clear_particles();
      for (std::size_t i = 0; i < grains.n(); ++i)
        insert(i);
      particles->update_cached_numbers();
      AssertThrow(particles->n_global_particles() == grains.n(), ExcInternalError());
    }

    /** Insert those that no rank has. */
    void rescue()
    {
      std::vector<unsigned int> found(grains.n(), 0);
      for (const auto &particle : *particles)
        ++found[number_of_id[particle.get_id()]];
      std::vector<unsigned int> found_anywhere(grains.n());
      Utilities::MPI::sum(found, communicator, found_anywhere);
      for (std::size_t i = 0; i < grains.n(); ++i)
        if (found_anywhere[i] == 0)
          {
            insert(i);
            ++n_rescued;
          }
      particles->update_cached_numbers();
      if (particles->n_global_particles() != grains.n())
        throw std::runtime_error("There are " + std::to_string(particles->n_global_particles()) +
                                 " grains instead of " + std::to_string(grains.n()) +
                                 ": grains were lost or doubled between ranks.");
    }

    /** Let the particles follow the arrays. */
    void update()
    {
      AssertThrow(n_cells[0] > 0, ExcNotInitialized());
      n_rescued = 0;
      if (!particles)
        make_grid();
      if (ids != grains.id || particles->n_global_particles() != grains.n())
        {
          insert_all();
          return;
        }
      // deal.II knows only the cells next to its own: who jumps farther is taken out here and put in again below
      std::vector<Particles::ParticleIterator<2>> far;
      for (auto particle = particles->begin(); particle != particles->end(); ++particle)
        {
          const auto i = number_of_id[particle->get_id()];
          if (!are_neighbors(particle->get_surrounding_cell()->center(), place(i)))
            {
              far.push_back(particle);
              continue;
            }
          particle->set_location(place(i));
          const auto values = particle->get_properties();
          for_each_property(
            grains, [&](const auto &column, const GrainColumn &, const unsigned int p) { values[p] = column[i]; });
        }
      particles->remove_particles(far);
      particles->sort_particles_into_subdomains_and_cells();
      particles->update_cached_numbers();
      if (particles->n_global_particles() != grains.n())
        rescue();
    }

    GrainArrays                                    grains;
    MPI_Comm                                       communicator;
    Point<2>                                       lower, upper; // of the grid
    std::array<unsigned int, 2>                    n_cells = {{0, 0}};
    std::array<double, 2>                          size    = {{0., 0.}}; // of a cell
    std::vector<Cell>                              my_cells; // by number; invalid where another rank owns it
    unsigned int                                   n_levels  = 0;
    std::vector<unsigned int>                      n_trees   = {0, 0};
    std::size_t                                    n_rescued = 0;
    std::vector<GrainId>                           ids; // that there are particles of
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


  GrainArrays &GrainStore::grains()
  {
    return implementation->grains;
  }


  const GrainArrays &GrainStore::grains() const
  {
    return implementation->grains;
  }


  void GrainStore::initialize(const std::array<double, 2> &lower, const std::array<double, 2> &upper, const double skin)
  {
    for (std::size_t i = 1; i < grains().n(); ++i)
      AssertThrow(grains().id[i - 1] < grains().id[i], ExcMessage("Grains must be sorted by their ids."));
    implementation->choose_grid(lower, upper, skin);
    implementation->check_positions(0.);
  }


  void GrainStore::let_leave(const bool yes)
  {
    implementation->may_leave = yes;
  }


  void GrainStore::check_positions(const double dt) const
  {
    implementation->check_positions(dt);
  }


  const Particles::ParticleHandler<2> &GrainStore::particles()
  {
    implementation->update();
    return *implementation->particles;
  }


  std::size_t GrainStore::n_local_particles() const
  {
    return implementation->particles ? implementation->particles->n_locally_owned_particles() : 0;
  }


  std::size_t GrainStore::n_rescued() const
  {
    return implementation->n_rescued;
  }


  void GrainStore::output(const std::function<void(DataOutInterface<0, 2> &)> &use)
  {
    GrainOutput output(particles(), grains(), implementation->number_of_id);
    use(output);
  }
} // namespace alluvium::grains
