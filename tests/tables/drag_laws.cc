#include "../coupling/named_law.h"

#include <alluvium/coupling/homogeneous_bed.h>

#include <gtest/gtest.h>

#include <cstdio>

using bed::d, bed::rho, bed::eta, bed::Law;

// The table of doc/lab/reports/drag.md: grains of 0.22 mm and 2630 kg/m^3 in water at a void fraction of 0.48.
TEST(DragLawsTable, Table)
{
  bed::grains::GrainArrays grains;
  grains.resize(1);
  grains.radius[0] = grains.fluid_radius[0] = 0.5 * d;
  grains.mass[0]                            = 2630. * dealii::numbers::PI * d * d / 4.;
  bed::fluid::FluidProperties fluid;
  fluid.density   = rho;
  fluid.viscosity = eta;
  const bed::coupling::HomogeneousBed homogeneous{grains, fluid, 0.48};
  const double                        dallavalle = homogeneous.permeability(*Law("sphere").law);
  std::printf("| law | void fraction | Reynolds number to | K / d^2 | K over that of `sphere` | fluidised at [mm/s] |\n"
              "|---|---|---|---|---|---|\n");
  for (const auto &[name, entry] : alluvium::Registry<bed::coupling::DragLaw>::entries())
    {
      if (name.find("(test)") != std::string::npos)
        continue;
      const Law    law(name);
      const auto   range = law.law->range();
      const double K     = homogeneous.permeability(*law.law);
      EXPECT_GT(K / dallavalle, 0.5) << name;
      EXPECT_LT(K / dallavalle, 2.) << name;
      std::printf("| `%s` | %g to %g | %g | %.3e | %.3f | %.3f |\n",
                  name.c_str(),
                  range.eps_min,
                  range.eps_max,
                  range.re_max,
                  K / (d * d),
                  K / dallavalle,
                  1e3 * homogeneous.fluidisation_velocity(*law.law, 9.81));
    }
}
