#include <alluvium/contacts/contact_stepper.h>
#include <alluvium/observers/observer.h>
#include <alluvium/utilities/atomic_file.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

namespace alluvium::observers
{
  namespace
  {
    /**
     * Mean contact stress of the grains, weighted with their areas (times the packing fraction it is that of the bed),
     * and the contacts as lines for ParaView, from centre to centre with the force that they carry.
     */
    class Stress : public Observer
    {
    public:
      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter("Interval of force chains",
                          interval,
                          "Time between two pictures of the contacts as lines from centre to centre, with the normal "
                          "and the tangential force they carry in the last sub-step [s]; 0: none.",
                          dealii::Patterns::Double(0.));
      }

      bool applies(const Snapshot &s) const override { return s.stepper != nullptr; }

      void add_columns(const Snapshot &, output::Statistics &statistics) override
      {
        for (const char *name : names)
          statistics.add_column(name);
      }

      void observe(const Snapshot &s) override
      {
        const double eps = 1e-6 * s.dt;
        if (interval > 0. &&
            (s.step == 0 || std::floor((s.time + eps) / interval) > std::floor((s.time - s.dt + eps) / interval)))
          write_lines(s);
      }

      void write(const Snapshot &s, output::Statistics &statistics) override
      {
        const auto            stresses = contacts::grain_stresses(s.grains, s.stepper->forces(s.grains));
        std::array<double, 3> mean{};
        double                area = 0.;
        for (std::size_t k = 0; k < stresses.size(); ++k)
          {
            const double a = grains::disc_volume(s.grains.radius[k]);
            area += a;
            mean[0] += a * stresses[k][0];
            mean[1] += a * 0.5 * (stresses[k][1] + stresses[k][2]);
            mean[2] += a * stresses[k][3];
          }
        for (unsigned int c = 0; c < 3; ++c)
          statistics.set(names[c], area > 0. ? mean[c] / area : 0.);
      }

      void save(nlohmann::ordered_json &state) const override { state = written; }
      void load(const nlohmann::ordered_json &state) override { written = state.get<decltype(written)>(); }

    private:
      static constexpr std::array<const char *, 3> names = {
        {"grain_stress_xx_Pa", "grain_stress_xy_Pa", "grain_stress_yy_Pa"}};

      double                                      interval = 0.;
      std::vector<std::pair<double, std::string>> written;

      void write_lines(const Snapshot &s)
      {
        const std::string  name   = "force-chains-" + dealii::Utilities::int_to_string(written.size(), 5) + ".vtp";
        const auto         forces = s.stepper->forces(s.grains); // collective
        std::ostringstream out;
        out.precision(9);
        out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n<Piece "
               "NumberOfPoints=\""
            << 2 * forces.size() << "\" NumberOfVerts=\"0\" NumberOfLines=\"" << forces.size()
            << "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<Points>\n<DataArray type=\"Float64\" "
               "NumberOfComponents=\"3\" format=\"ascii\">\n";
        for (const auto &f : forces)
          {
            const double x = s.grains.position[0][f.i], y = s.grains.position[1][f.i];
            out << x << ' ' << y << " 0 " << x + f.length * f.nx << ' ' << y + f.length * f.ny << " 0\n";
          }
        out << "</DataArray>\n</Points>\n<Lines>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
        for (std::size_t k = 0; k < 2 * forces.size(); ++k)
          out << k << '\n';
        out << "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
        for (std::size_t k = 1; k <= forces.size(); ++k)
          out << 2 * k << '\n';
        out << "</DataArray>\n</Lines>\n<CellData Scalars=\"normal_force\">\n<DataArray type=\"Float64\" "
               "Name=\"normal_force\" format=\"ascii\">\n";
        for (const auto &f : forces)
          out << f.normal << '\n';
        out << "</DataArray>\n<DataArray type=\"Float64\" Name=\"tangential_force\" format=\"ascii\">\n";
        for (const auto &f : forces)
          out << f.tangential << '\n';
        out << "</DataArray>\n</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
        write_atomically(s.communicator, s.folder + "/" + name, out.str());
        written.emplace_back(s.time, name);
        std::ostringstream list;
        dealii::DataOutBase::write_pvd_record(list, written);
        write_atomically(s.communicator, s.folder + "/force-chains.pvd", list.str());
      }
    };
  } // namespace

  ALLUVIUM_REGISTER_OBSERVER(Stress,
                             "stress",
                             "Mean contact stress of the grains; force chains for ParaView if asked for.")
} // namespace alluvium::observers
