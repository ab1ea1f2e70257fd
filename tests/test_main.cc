// Common main() of the unit tests: MPI is up, so that tests may use deal.II's distributed classes.
#include <alluvium/utilities/mpi_environment.h>

#include <gtest/gtest.h>

int main(int argc, char **argv)
{
  const alluvium::MpiEnvironment mpi(argc, argv);
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
