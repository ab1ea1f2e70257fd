#include <alluvium/utilities/mpi_environment.h>

#include <array>
#include <cstdlib>

#include <dlfcn.h>

namespace alluvium
{
  namespace
  {
    /** Looked up at run time: which BLAS this is, is the system's choice. */
    void one_blas_thread()
    {
      struct Library
      {
        const char *variable, *function;
      };
      constexpr std::array<Library, 2> libraries{
        {{"OPENBLAS_NUM_THREADS", "openblas_set_num_threads"}, {"MKL_NUM_THREADS", "MKL_Set_Num_Threads"}}};
      for (const Library &library : libraries)
        if (!std::getenv(library.variable) && !std::getenv("OMP_NUM_THREADS"))
          if (void *set_n_threads = dlsym(RTLD_DEFAULT, library.function))
            reinterpret_cast<void (*)(int)>(set_n_threads)(1);
    }
  } // namespace


  MpiEnvironment::MpiEnvironment(int &argc, char **&argv)
    : mpi(argc, argv, 1)
  {
    one_blas_thread();
  }
} // namespace alluvium
