// Treatments of low void fractions: the law itself in beds, finite below. Their tables are in tests/tables.
#include "bed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{
  using Registry = alluvium::Registry<bed::coupling::DragRegularisation>;
} // namespace

TEST(DragRegularisation, FiniteFromZeroToOneAndTheLawInBeds)
{
  const auto   law = alluvium::Registry<bed::coupling::DragLaw>::entries().at("disc").create();
  const double d = 2.2e-4, eta = 1e-3;
  for (const auto &[name, entry] : Registry::entries())
    {
      const auto               regularisation = entry.create();
      dealii::ParameterHandler prm;
      regularisation->add_parameters(prm);
      double last = std::numeric_limits<double>::infinity();
      for (double eps = 0.; eps < 1.; eps += 1e-3)
        {
          const double gamma = regularisation->gamma(*law, {eps, 0., d, 1000., eta});
          EXPECT_GT(gamma, 0.) << name << ' ' << eps;
          EXPECT_TRUE(std::isfinite(gamma)) << name << ' ' << eps;
          EXPECT_LE(gamma, last) << name << ' ' << eps; // the denser, the more
          last = gamma;
          if (eps > 0.35)
            {
              EXPECT_DOUBLE_EQ(gamma, law->gamma({eps, 0., d, 1000., eta})) << name << ' ' << eps;
            }
        }
    }
  const auto               floor = Registry::entries().at("floor").create();
  dealii::ParameterHandler prm;
  floor->add_parameters(prm);
  prm.set("Minimal void fraction", 0.3);
  EXPECT_DOUBLE_EQ(floor->gamma(*law, {0.1, 0., d, 1000., eta}), law->gamma({0.3, 0., d, 1000., eta}));
}
