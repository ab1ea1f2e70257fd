#include <alluvium/utilities/signals.h>

#include <csignal>
#include <initializer_list>

namespace alluvium
{
  namespace
  {
    volatile std::sig_atomic_t stop_signal = 0;

    extern "C" void remember_signal(const int signal)
    {
      stop_signal = signal;
    }
  } // namespace

  void install_stop_signals()
  {
    struct sigaction action = {};
    action.sa_handler       = remember_signal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART | SA_RESETHAND; // RESETHAND: the second one kills
    for (const int signal : {SIGINT, SIGTERM, SIGUSR1})
      sigaction(signal, &action, nullptr);
  }

  void ignore_file_limit_signal()
  {
    std::signal(SIGXFSZ, SIG_IGN);
  }

  int stop_requested(MPI_Comm communicator)
  {
    int mine = stop_signal, any = 0;
    MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, communicator);
    return any;
  }

  std::string signal_name(const int signal)
  {
    return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : signal == SIGUSR1 ? "SIGUSR1" : "a signal";
  }
} // namespace alluvium
