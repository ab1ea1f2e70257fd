#include <alluvium/fluid/given_velocity.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    // a formula is looked at in each of so many pieces of a face: more where it may jump, for narrow slots
    constexpr unsigned int n_pieces_of_smooth = 16, n_pieces_of_others = 256;
    constexpr unsigned int max_depth = 40;

    // fluid is not made faster than this where grains take nearly all room
    constexpr double least_void_fraction = 0.1;

    /** Integrals over a face, which is 0 to 1 here, of a velocity against phi_0^2, phi_0 phi_1, phi_1^2. */
    template <int dim>
    using Moments = std::array<Tensor<1, dim>, 3>;

    template <int dim, typename Velocity>
    Moments<dim> lobatto(const Velocity &velocity, const double a, const double b)
    {
      // with the ends, or a jump could hide between the last point of a piece and the first of the next
      static const double x[] = {0., 0.5 - std::sqrt(0.05), 0.5 + std::sqrt(0.05), 1.},
                          w[] = {1. / 12., 5. / 12., 5. / 12., 1. / 12.};
      Moments<dim> sum;
      for (unsigned int q = 0; q < 4; ++q)
        {
          const double s = a + x[q] * (b - a);
          const auto   u = w[q] * (b - a) * velocity(s);
          sum[0] += (1. - s) * (1. - s) * u;
          sum[1] += (1. - s) * s * u;
          sum[2] += s * s * u;
        }
      return sum;
    }

    /** Halve [a, b] until both halves agree with the whole, to @p tolerance. */
    template <int dim, typename Velocity>
    Moments<dim> halve(const Velocity     &velocity,
                       const double        a,
                       const double        b,
                       const Moments<dim> &whole,
                       const double        tolerance,
                       const unsigned int  depth)
    {
      const double middle = 0.5 * (a + b);
      const auto   left = lobatto<dim>(velocity, a, middle), right = lobatto<dim>(velocity, middle, b);
      Moments<dim> sum;
      double       defect = 0.;
      for (unsigned int i = 0; i < 3; ++i)
        {
          sum[i] = left[i] + right[i];
          defect = std::max(defect, (sum[i] - whole[i]).norm());
        }
      if (defect <= tolerance || depth == max_depth)
        return sum;
      const auto l = halve<dim>(velocity, a, middle, left, tolerance, depth + 1),
                 r = halve<dim>(velocity, middle, b, right, tolerance, depth + 1);
      for (unsigned int i = 0; i < 3; ++i)
        sum[i] = l[i] + r[i];
      return sum;
    }

    template <int dim, typename Velocity>
    Moments<dim>
    integrate_part(const Velocity &velocity, const double from, const double to, const unsigned int n_pieces)
    {
      Moments<dim> sum;
      double       size = 0.;
      const double step = (to - from) / n_pieces;
      for (unsigned int i = 0; i < n_pieces; ++i)
        for (const double s : {0.1, 0.5, 0.9})
          size = std::max(size, velocity(from + (i + s) * step).norm());
      for (unsigned int i = 0; i < n_pieces; ++i)
        {
          const double a = from + i * step, b = i + 1 == n_pieces ? to : a + step;
          const auto   m = halve<dim>(velocity, a, b, lobatto<dim>(velocity, a, b), 1e-13 * size * (to - from), 0);
          for (unsigned int k = 0; k < 3; ++k)
            sum[k] += m[k];
        }
      return sum;
    }
  } // namespace


  template <int dim>
  void GivenVelocity<dim>::integrate(const FluidSpace<dim> &space, const BoundaryConditions<dim> &conditions)
  {
    const auto velocity_at = [&](const auto &condition, const Point<dim> &point) {
      Tensor<1, dim> u;
      for (unsigned int d = 0; d < dim; ++d)
        u[d] = conditions.value(condition, point, d);
      return u;
    };
    moments.clear();
    of_formula.clear();
    const auto                                       &nodes = space.boundary().inflow_nodes();
    std::map<types::global_dof_index, Tensor<1, dim>> carried; // by the node's shape function [m^2/s]
    std::map<types::global_dof_index, bool>           resolved;
    for (const InflowFace<dim> &face : space.boundary().inflow_faces())
      {
        const auto &condition = conditions.all().at(face.boundary);
        const auto  velocity  = [&](const double s) {
          return velocity_at(condition, Point<dim>((1. - s) * face.end[0] + s * face.end[1]));
        };
        Moments m = integrate_part<dim>(
          velocity, face.from, face.to, condition.may_jump() ? n_pieces_of_others : n_pieces_of_smooth);
        for (auto &moment : m)
          moment *= face.length();
        moments.push_back(m);
        // would the values at the nodes carry the same?
        const Tensor<1, dim> ends[2] = {velocity(face.from), velocity(face.to)};
        double               defect = 0., size = 0.;
        for (unsigned int e = 0; e < 2; ++e)
          {
            const auto flux = m[e] + m[e + 1];
            defect          = std::max(defect, (flux - face.length() / 6. * (2. * ends[e] + ends[1 - e])).norm());
            size            = std::max({size, flux.norm(), 0.5 * face.length() * ends[e].norm()});
          }
        const bool fits = defect <= 0.1 * size;
        for (unsigned int e = 0; e < 2; ++e)
          {
            const auto node = nodes.find(face.node[e]);
            if (node == nodes.end() || std::abs(node->second.normal * face.normal) < 0.9)
              continue;
            carried[face.node[e]] += m[e] + m[e + 1];
            resolved.emplace(face.node[e], node->second.whole).first->second &= fits;
          }
      }
    for (const auto &[index, node] : nodes)
      of_formula[index] =
        resolved[index] ? velocity_at(conditions.all().at(node.boundary), node.point) : carried[index] / node.length;
  }


  template <int dim>
  void GivenVelocity<dim>::update(const FluidSpace<dim>         &space,
                                  const BoundaryConditions<dim> &conditions,
                                  const Vector                  &void_fraction)
  {
    if (!known || (conditions.current_time() != time && conditions.velocity_depends_on_time()))
      integrate(space, conditions);
    known                    = true;
    time                     = conditions.current_time();
    const bool  interstitial = conditions.velocity_is_interstitial();
    const auto &faces        = space.boundary().inflow_faces();
    fluxes.resize(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i)
      {
        const double eps[2] = {interstitial ? void_fraction(faces[i].node[0]) : 1.,
                               interstitial ? void_fraction(faces[i].node[1]) : 1.};
        for (unsigned int e = 0; e < 2; ++e)
          fluxes[i][e] = (eps[0] * moments[i][e] + eps[1] * moments[i][e + 1]) * faces[i].normal;
      }
    values = of_formula;
    if (!interstitial)
      for (auto &[node, velocity] : values)
        velocity /= std::max(void_fraction(node), least_void_fraction);
  }


  template <int dim>
  std::map<types::boundary_id, double>
  GivenVelocity<dim>::boundary_fluxes(const FluidSpace<dim> &space, const BoundaryConditions<dim> &conditions) const
  {
    std::map<types::boundary_id, double> result;
    for (const auto &[id, condition] : conditions.all())
      if (condition.kind->velocity() == BoundaryKind<dim>::Velocity::given)
        result[id] = 0.;
    const auto &faces = space.boundary().inflow_faces();
    for (std::size_t i = 0; i < fluxes.size(); ++i)
      if (faces[i].owned)
        result[faces[i].boundary] += fluxes[i][0] + fluxes[i][1];
    for (auto &[id, flux] : result)
      flux = Utilities::MPI::sum(flux, space.communicator());
    return result;
  }


  template class GivenVelocity<2>;
} // namespace alluvium::fluid
