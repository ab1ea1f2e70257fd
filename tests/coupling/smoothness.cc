// The force on a disc that is dragged across cells at constant velocity: it shall not feel where the cells end.
#include "dragged_grain.h"

#include <gtest/gtest.h>

using namespace moving_grain;

TEST(Smoothness, DraggedGrain)
{
  for (const double h : {4., 1.})
    for (const bool triangles : {false, true})
      {
        bed::Settings s;
        s.h_over_d  = h;
        s.triangles = triangles;
        EXPECT_LT(dragged(s, 0.02, 1.5).second_difference, 1e-3) << "h/d " << h << " triangles " << triangles;
        s.smooth = true;
        EXPECT_LT(dragged(s, 0.04, 1.5).second_difference, 7e-4) << "h/d " << h << " triangles " << triangles;
      }
  // the measure sees cells where they are felt
  bed::Settings s;
  s.filter = 0.;
  EXPECT_GT(dragged(s, 0.02, 1.5).second_difference, 1e-2);
}

TEST(Smoothness, GrainInGivenFlow)
{
  for (const double h : {4., 2., 1., 0.5, 0.25})
    {
      bed::Settings s;
      s.h_over_d = h;
      EXPECT_LT(in_given_flow(s, 0.02, 4.).second_difference, 1e-3) << "h/d " << h;
    }
}
