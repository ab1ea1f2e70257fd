#include <alluvium/output/wall_output.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/mpi.h>
#include <deal.II/grid/reference_cell.h>

#include <array>
#include <string>
#include <tuple>

namespace alluvium::output
{
  using namespace dealii;

  namespace
  {
    class WallLines : public DataOutInterface<1, 2>
    {
    public:
      explicit WallLines(const std::vector<grains::WallSegment> &walls)
      {
        for (const auto &wall : walls)
          {
            if (!wall.present)
              continue;
            DataOutBase::Patch<1, 2> patch;
            patch.reference_cell = ReferenceCells::Line;
            patch.patch_index    = patches.size();
            patch.data.reinit(2, 2);
            for (unsigned int e = 0; e < 2; ++e)
              {
                const auto &end   = e == 0 ? wall.a : wall.b;
                patch.vertices[e] = Point<2>(end[0], end[1]);
                const auto v      = wall.velocity_at(end[0], end[1]);
                for (unsigned int d = 0; d < 2; ++d)
                  patch.data(d, e) = v[d];
              }
            patches.push_back(patch);
          }
      }

    protected:
      const std::vector<DataOutBase::Patch<1, 2>> &get_patches() const override { return patches; }
      std::vector<std::string> get_dataset_names() const override { return {"velocity", "velocity"}; }
      std::vector<
        std::tuple<unsigned int, unsigned int, std::string, DataComponentInterpretation::DataComponentInterpretation>>
      get_nonscalar_data_ranges() const override
      {
        return {std::make_tuple(0u, 1u, "velocity", DataComponentInterpretation::component_is_part_of_vector)};
      }

    private:
      std::vector<DataOutBase::Patch<1, 2>> patches;
    };
  } // namespace


  void write_walls(FieldSeries                            &series,
                   const std::vector<grains::WallSegment> &walls,
                   const double                            time,
                   const MPI_Comm                          communicator)
  {
    // all ranks have them: one shows them
    WallLines lines(Utilities::MPI::this_mpi_process(communicator) == 0 ? walls : std::vector<grains::WallSegment>());
    series.write<1>(lines, ReferenceCells::Line, time);
  }
} // namespace alluvium::output
