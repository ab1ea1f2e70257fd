#pragma once

#include <string>

namespace alluvium
{
  /**
   * While it lives, the program works in a folder of its choice: MPI-IO's file names may be short then. Open MPI's
   * shared file pointers overrun a buffer of 256 characters with long ones. Throws UserError if there is no such
   * folder.
   */
  class WorkingFolder
  {
  public:
    explicit WorkingFolder(const std::string &folder);
    ~WorkingFolder();
    WorkingFolder(const WorkingFolder &)            = delete;
    WorkingFolder &operator=(const WorkingFolder &) = delete;

  private:
    int before; // open folder
  };
} // namespace alluvium
