#pragma once

#include <alluvium/deposits/deposit.h>

#include <string>
#include <vector>

namespace alluvium::deposits
{
  /** A bed that was made by a recipe and is kept in a file for other runs. */
  class DepositCache
  {
  public:
    /** In @p folder, under a name that depends on @p recipe: lines of text with all that makes the bed what it is. */
    DepositCache(const std::string &folder, const std::string &recipe);

    /**
     * Whether there is a bed of this recipe that is whole, number of grains and checksum; fills @p new_grains. What is
     * there and cannot be used (cut off, altered, a folder) is named in @p remark.
     */
    bool read(std::vector<NewGrain> &new_grains, std::string &remark) const;

    /** Keep @p new_grains; @p measured are further lines for whoever opens the file. Throws UserError. */
    void write(const std::vector<NewGrain> &new_grains, const std::string &measured) const;

    const std::string folder, recipe, file;
  };
} // namespace alluvium::deposits
