#include <alluvium/utilities/version.h>

#include <alluvium_commit.h> // written by the build, see source/commit.cmake

namespace alluvium
{
  std::string version()
  {
    const std::string commit = ALLUVIUM_COMMIT;
    return ALLUVIUM_VERSION + (commit.empty() ? std::string() : " (" + commit + ")");
  }
} // namespace alluvium
