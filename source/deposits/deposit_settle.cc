#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/deposits/deposit_settle.h>
#include <alluvium/grains/packing.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace alluvium::deposits
{
  namespace
  {
    /** Neighbours in space become neighbours in memory: rows of about one diameter, from left to right. */
    void sort_into_rows(const DepositBox &box, std::vector<NewGrain> &new_grains)
    {
      double row = 0.;
      for (const NewGrain &s : new_grains)
        row = std::max(row, 2. * s.radius);
      std::sort(new_grains.begin(), new_grains.end(), [&](const NewGrain &a, const NewGrain &b) {
        const double ra = std::floor((a.y - box.lower[1]) / row), rb = std::floor((b.y - box.lower[1]) / row);
        return ra != rb ? ra < rb : a.x != b.x ? a.x < b.x : a.y < b.y;
      });
    }

    std::vector<grains::WallSegment> floor_and_sides(const DepositBox &box)
    {
      const double                     far   = box.upper[1] + 1e3 * (box.width() + box.height());
      std::vector<grains::WallSegment> walls = {{box.lower, {{box.upper[0], box.lower[1]}}, {{0., 0.}}, "floor"}};
      if (!box.periodic[0])
        {
          walls.push_back({{{box.lower[0], far}}, box.lower, {{0., 0.}}, "left"});
          walls.push_back({{{box.upper[0], box.lower[1]}}, {{box.upper[0], far}}, {{0., 0.}}, "right"});
        }
      return walls;
    }

    /** Those that stand in the box, too; what will move stands still. */
    std::vector<grains::WallSegment> all_walls(const Settling &settling)
    {
      std::vector<grains::WallSegment> walls = floor_and_sides(settling.box);
      for (const grains::WallSegment &wall : settling.walls)
        walls.push_back({wall.a, wall.b, {{0., 0.}}, wall.name});
      return walls;
    }

    /** A bed in a thick fluid, in which a falling grain sinks by g 2 dt^2 a step, and nothing swings. */
    class ThickBed
    {
    public:
      ThickBed(const Settling &settling, const std::vector<NewGrain> &new_grains)
        : settling(settling)
        , n(new_grains.size())
        , periodicity({settling.box.lower, {{settling.box.periodicity().length[0], 0.}}})
      {
        grains.resize(n);
        loads.reset(n);
        for (std::size_t k = 0; k < n; ++k)
          smallest = std::min(smallest, 2. * new_grains[k].radius);
        dt = 0.2 * std::sqrt(smallest / settling.g);
        for (std::size_t k = 0; k < n; ++k)
          {
            const NewGrain &s     = new_grains[k];
            grains.id[k]          = static_cast<grains::GrainId>(k);
            grains.position[0][k] = s.x;
            grains.position[1][k] = s.y;
            grains.radius[k]      = s.radius;
            grains.mass[k]        = grains::disc_mass(s.density, s.radius);
            loads.force[1][k]     = -grains.mass[k] * settling.g;
            loads.drag[k]         = grains.mass[k] / (2. * dt);
            weight -= loads.force[1][k];
          }
      }

      /** Take all motion and all knowledge of contact forces away. */
      void start_cold(const double tolerance, const double largest_violation)
      {
        for (auto *v : {&grains.velocity[0], &grains.velocity[1], &grains.omega})
          std::fill(v->begin(), v->end(), 0.);
        stepper = std::make_unique<contacts::ContactStepper>();
        stepper->set_walls(all_walls(settling));
        stepper->set_periodicity(periodicity);
        contacts::ContactSettings &settings = stepper->settings();
        settings.friction = settings.wall_friction = settling.friction;
        settings.rest_steps                        = 0; // what is still is judged here
        settings.residual_tolerance                = tolerance;
        settings.violation_tolerance               = largest_violation;
        settings.smooth_tolerance                  = 1e-4;
        settings.stagnation_sweeps                 = 100;
        // Beds stay as they are only under steps whose dead zone is no smaller.
        settings.dead_zone *= 0.1;
        solve_step();
        // Single grains roll on for long. The bed below them must not be solved anew for each.
        settings.moving_speed = 0.;
      }

      /** Take some steps. */
      void go_on()
      {
        constexpr unsigned int    n_window = 10;
        const std::vector<double> x = grains.position[0], y = grains.position[1];
        double                    carried = 0.;
        for (unsigned int s = 0; s < n_window; ++s)
          carried += solve_step() / n_window;
        double square = 0.;
        n_moved       = 0;
        for (std::size_t k = 0; k < n; ++k)
          {
            double dx = grains.position[0][k] - x[k], dy = grains.position[1][k] - y[k];
            periodicity.shorten(dx, dy);
            const double way = std::hypot(dx, dy);
            square += way * way;
            n_moved += way > 1e-3 * smallest;
          }
        moved         = std::sqrt(square / n);
        state.speed   = moved / (n_window * dt);
        state.support = carried;
      }

      bool falls() const { return moved > 1e-2 * smallest; }
      /** Whether in these steps hardly a grain has moved, and the walls carried the bed. */
      bool is_still() const { return n_moved <= n / 10000 && std::abs(state.support - 1.) < 1e-3; }

      const Settling      settling;
      grains::GrainArrays grains;
      SettledState        state;
      double              smallest = std::numeric_limits<double>::max();

    private:
      const std::size_t                         n;
      const grains::Periodicity                 periodicity; // there is always a floor
      grains::GrainLoads                        loads;
      double                                    dt = 0., weight = 0., moved = 0.; // root mean square
      std::size_t                               n_moved = 0;
      std::unique_ptr<contacts::ContactStepper> stepper;

      /** Part of the weight that the walls carry. */
      double solve_step()
      {
        const contacts::ContactReport report = stepper->advance(grains, loads, dt, {{0., -settling.g}});
        ++state.n_steps;
        state.mean_penetration = report.mean_penetration;
        double carried         = 0.;
        for (const auto &[name, force] : report.wall_force)
          carried -= force[1] / weight;
        return carried;
      }
    };
  } // namespace


  SettledState bring_to_rest(const Settling &settling, std::vector<NewGrain> &new_grains)
  {
    sort_into_rows(settling.box, new_grains);
    ThickBed bed(settling, new_grains);
    double   height = 0.;
    for (const NewGrain &s : new_grains)
      height = std::max(height, s.y - settling.box.lower[1]);
    // of the weight of a grain, and the deeper the bed, the more its contacts carry
    const double       carried = std::max(1., 0.25 * height / bed.smallest);
    const unsigned int n_steps = 2000 + static_cast<unsigned int>(5. * height / bed.smallest);
    if (settling.loose)
      {
        bed.start_cold(1e-5 * carried, 1e-4 * carried);
        do
          bed.go_on();
        while (bed.falls() && bed.state.n_steps < n_steps);
      }
    // Many forces can hold a bed, and some hold single grains that others let go. It shall stay in a run that begins
    // without knowing them: so it is brought to rest twice. An error of the contacts that is smooth over the depth
    // makes a deep bed creep and swing, hence the tolerance.
    for (unsigned int pass = 0; pass < 2; ++pass)
      {
        bed.start_cold(1e-7 * carried, 1e-4 * carried);
        const unsigned int last = bed.state.n_steps + n_steps;
        do
          bed.go_on();
        while (!bed.is_still() && bed.state.n_steps < last);
      }
    check_user(bed.is_still(),
               "The deposit 'settled bed' did not come to rest in " + std::to_string(bed.state.n_steps) +
                 " steps: its grains still move at " + in_digits(bed.state.speed) + " m/s, and floor and sides carry " +
                 in_digits(bed.state.support) + " of the weight. Try another seed, or other friction while settling.");
    for (std::size_t k = 0; k < new_grains.size(); ++k)
      {
        new_grains[k].x = bed.grains.position[0][k];
        new_grains[k].y = bed.grains.position[1][k];
      }
    bed.state.packing = inner_packing_fraction(bed.grains);
    return bed.state;
  }
} // namespace alluvium::deposits
