// Common main() of the unit tests: MPI is up, so that tests may use deal.II's distributed classes.
#include <alluvium/utilities/mpi_environment.h>

#include <gtest/gtest.h>

#include <cstdio>

int main(int argc, char **argv)
{
  const alluvium::MpiEnvironment mpi(argc, argv);
  ::testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  // a filter that matches nothing is a mistake in the list of tests, and must not pass
  if (failed == 0 && !GTEST_FLAG_GET(list_tests) && ::testing::UnitTest::GetInstance()->test_to_run_count() == 0)
    {
      std::fprintf(stderr, "No test matches --gtest_filter=%s.\n", GTEST_FLAG_GET(filter).c_str());
      return 1;
    }
  return failed;
}
