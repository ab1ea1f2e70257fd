// Nanoseconds for one overlap, by mesh, kind of piece and h/d = 8 ... 1/8, over random discs. The pairs (disc, cell)
// are found beforehand and taken in the order of the discs, so that branches are as unpredictable as in real use.
#include <alluvium/geometry/disc_polygon_overlap.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../geometry/meshes.h"

using namespace overlap_test;

namespace
{
  enum Kind
  {
    cut, // part of the cell, part of the disc
    cell_in_disc,
    disc_in_cell,
    disjoint, // nothing in common, for cells within a ring about the disc
    all       // whatever meets the disc's bounding box, as a caller with a search grid sees it
  };

  Kind kind_of(const Disc &disc, const PreparedPolygon &cell)
  {
    const double a = overlap(disc, cell).area;
    if (a == 0.)
      return disjoint;
    if (a == cell.area)
      return cell_in_disc;
    return a > (1 - 1e-14) * M_PI * disc.radius * disc.radius ? disc_in_cell : cut;
  }

  void time_overlap(benchmark::State &state, const Shape shape, const double ratio, const Kind kind)
  {
    const Mesh mesh(shape, 100, 1.);
    Rng        rng(3);

    std::vector<std::pair<Disc, unsigned>> pairs;
    for (unsigned i = 0; i < 200000 && pairs.size() < 20000; ++i)
      {
        const Disc disc = random_disc(mesh, 0.5 / ratio, rng);
        mesh.for_each_near(disc, [&](const unsigned c) {
          const PreparedPolygon &cell = mesh.cells[c];
          const bool             near = std::abs(cell.lower[0] + cell.upper[0] - 2 * disc.centre[0]) <
                              2 * disc.radius + cell.upper[0] - cell.lower[0] &&
                            std::abs(cell.lower[1] + cell.upper[1] - 2 * disc.centre[1]) <
                              2 * disc.radius + cell.upper[1] - cell.lower[1];
          if (kind == all ? near : kind_of(disc, cell) == kind)
            pairs.emplace_back(disc, c);
        });
      }
    if (pairs.empty())
      {
        state.SkipWithError("no such piece");
        return;
      }
    std::size_t k = 0;
    for (auto _ : state)
      {
        benchmark::DoNotOptimize(overlap(pairs[k].first, mesh.cells[pairs[k].second]));
        k = (k + 1 == pairs.size() ? 0 : k + 1);
      }
    state.counters["pairs"] = pairs.size();
  }
} // namespace


int main(int argc, char **argv)
{
  const std::pair<Kind, const char *> kinds[] = {
    {cut, "cut"}, {cell_in_disc, "cell in disc"}, {disc_in_cell, "disc in cell"}, {disjoint, "disjoint"}, {all, "all"}};
  for (const Shape shape : {Shape::squares, Shape::triangles, Shape::distorted})
    for (const auto &kind : kinds)
      for (const double ratio : {8., 4., 2., 1., 0.5, 0.25, 0.125})
        if (!(kind.first == cell_in_disc && ratio > 0.6) && !(kind.first == disc_in_cell && ratio < 1.9))
          {
            std::string label = std::to_string(ratio);
            label.erase(label.find_last_not_of("0.") + 1);
            benchmark::RegisterBenchmark(
              (std::string(name(shape)) + "/" + kind.second + "/h per d " + label).c_str(),
              [=](benchmark::State &state) { time_overlap(state, shape, ratio, kind.first); });
          }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
