#include <alluvium/coupling/piece_field.h>
#include <alluvium/fluid/piece_gradients.h>

namespace alluvium::coupling
{
  namespace
  {
    /** A nodal field on a cell: c[0] + c[1] xi + c[2] eta + c[3] xi eta. */
    struct Bilinear
    {
      std::array<double, 4> c;

      /** For @p n nodes; on triangles there is no last term. */
      Bilinear(const std::array<double, 4> &nodal, const unsigned int n)
        : c{{nodal[0],
             nodal[1] - nodal[0],
             nodal[2] - nodal[0],
             n == 4 ? nodal[0] - nodal[1] - nodal[2] + nodal[3] : 0.}}
      {}
    };
  } // namespace


  void evaluate(const OverlapMap           &map,
                const fluid::FluidSpace<2> &space,
                const fluid::BlockVector   &field,
                std::vector<PieceField>    &result)
  {
    const auto        &terms = map.terms();
    const unsigned int n     = space.n_nodes_per_cell();
    result.resize(terms.n_pieces());
    for (unsigned int c = 0; c < space.cells().size(); ++c)
      {
        if (terms.begin[c] == terms.begin[c + 1])
          continue;
        const auto                          &cell = space.cells()[c];
        std::array<std::array<double, 4>, 2> u{};
        std::array<double, 4>                p{};
        for (unsigned int v = 0; v < n; ++v)
          {
            p[v] = field.block(1).local_element(cell.pressure[v]);
            for (unsigned int d = 0; d < 2; ++d)
              u[d][v] = field.block(0).local_element(cell.velocity[v][d]);
          }
        const std::array<Bilinear, 2> velocity = {{Bilinear(u[0], n), Bilinear(u[1], n)}};
        const Bilinear                pressure(p, n);
        for (unsigned int k = terms.begin[c]; k < terms.begin[c + 1]; ++k)
          {
            const auto  &phi = terms.shape[k].phi; // phi[3] is the mean of xi eta, zero on triangles
            const double xi = phi[1] + phi[3], eta = phi[2] + phi[3];
            PieceField  &f = result[k];
            for (unsigned int d = 0; d < 2; ++d)
              f.u[d] = velocity[d].c[0] + velocity[d].c[1] * xi + velocity[d].c[2] * eta + velocity[d].c[3] * phi[3];
            const double by_xi = pressure.c[1] + pressure.c[3] * eta, by_eta = pressure.c[2] + pressure.c[3] * xi;
            const auto  &inverse = cell.parallelogram ? cell.to_reference : fluid::to_reference_at(cell, xi, eta);
            for (unsigned int d = 0; d < 2; ++d)
              f.grad_p[d] = by_xi * inverse[0][d] + by_eta * inverse[1][d];
          }
      }
  }


  std::vector<VelocityGradient>
  velocity_gradients(const OverlapMap &map, const fluid::FluidSpace<2> &space, const fluid::BlockVector &field)
  {
    const auto                   &terms = map.terms();
    std::vector<VelocityGradient> result(terms.n_pieces());
    const auto                    add = [&](auto n) {
      for (unsigned int c = 0; c < space.cells().size(); ++c)
        for (unsigned int k = terms.begin[c]; k < terms.begin[c + 1]; ++k)
          {
            const auto grad = fluid::piece_gradients<n>(space.cells()[c], terms.shape[k].phi);
            for (unsigned int v = 0; v < n; ++v)
              for (unsigned int i = 0; i < 2; ++i)
                for (unsigned int d = 0; d < 2; ++d)
                  result[k][i][d] += field.block(0).local_element(space.cells()[c].velocity[v][i]) * grad[v][d];
          }
    };
    if (space.n_nodes_per_cell() == 3)
      add(std::integral_constant<int, 3>());
    else
      add(std::integral_constant<int, 4>());
    return result;
  }
} // namespace alluvium::coupling
