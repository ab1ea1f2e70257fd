#pragma once

namespace alluvium
{
  /** The program: command line in, exit code out (see --help). */
  int run_application(int argc, char **argv);
} // namespace alluvium
