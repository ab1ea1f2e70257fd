#include <alluvium/mesh/straight_sides.h>

#include <map>

namespace alluvium::mesh
{
  using namespace dealii;

  template <int dim>
  std::vector<std::array<Point<dim>, 2>> straight_sides(const Triangulation<dim>        &triangulation,
                                                        const std::vector<Side>         &sides,
                                                        std::vector<types::boundary_id> &side_ids)
  {
    const auto                                      &vertex = triangulation.get_vertices();
    std::map<unsigned int, std::vector<std::size_t>> at_vertex;
    for (std::size_t s = 0; s < sides.size(); ++s)
      {
        at_vertex[sides[s].a].push_back(s);
        at_vertex[sides[s].b].push_back(s);
      }

    std::vector<std::array<Point<dim>, 2>> result;
    std::vector<bool>                      used(sides.size(), false);
    for (std::size_t s = 0; s < sides.size(); ++s)
      if (!used[s])
        {
          used[s] = true;
          std::array<unsigned int, 2> ends{{sides[s].a, sides[s].b}};
          const Tensor<1, dim>        direction = vertex[ends[1]] - vertex[ends[0]];
          for (unsigned int &end : ends)
            for (bool go_on = true; go_on;)
              {
                go_on             = false;
                const auto &meets = at_vertex.at(end);
                if (meets.size() != 2)
                  break;
                const std::size_t next = used[meets[0]] ? meets[1] : meets[0];
                if (used[next] || sides[next].id != sides[s].id)
                  break;
                const unsigned int   far  = sides[next].a == end ? sides[next].b : sides[next].a;
                const Tensor<1, dim> step = vertex[far] - vertex[end];
                // a polygonal arc has corners of far more than 1e-9
                const Tensor<1, dim> across = step - (step * direction) / direction.norm_square() * direction;
                // the tip of a crack, whose other face leads back
                const Tensor<1, dim> so_far = vertex[end] - vertex[ends[&end == &ends[0] ? 1 : 0]];
                if (across.norm() > 1e-9 * step.norm() || step * so_far < 0.)
                  break;
                used[next] = true;
                end        = far;
                go_on      = true;
              }
          result.push_back({{vertex[ends[0]], vertex[ends[1]]}});
          side_ids.push_back(sides[s].id);
        }
    return result;
  }


  template std::vector<std::array<Point<2>, 2>>
  straight_sides<2>(const Triangulation<2> &, const std::vector<Side> &, std::vector<types::boundary_id> &);
} // namespace alluvium::mesh
