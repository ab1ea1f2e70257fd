#include <gtest/gtest.h>

#include <cstdlib>

#include <dlfcn.h>

// test_main.cc starts MPI as the program does.
TEST(MpiEnvironment, OneBlasThread)
{
  void *n_threads = dlsym(RTLD_DEFAULT, "openblas_get_num_threads");
  if (!n_threads)
    GTEST_SKIP() << "BLAS is not OpenBLAS here";
  if (std::getenv("OPENBLAS_NUM_THREADS") || std::getenv("OMP_NUM_THREADS"))
    GTEST_SKIP() << "the environment has set the number of threads";
  EXPECT_EQ(reinterpret_cast<int (*)()>(n_threads)(), 1);
}
