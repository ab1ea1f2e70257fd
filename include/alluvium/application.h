#pragma once

namespace alluvium
{
  /** The program: command line in, exit code out (0 done, 1 a mistake of the user, 2 anything else that went wrong). */
  int run_application(int argc, char **argv);
} // namespace alluvium
