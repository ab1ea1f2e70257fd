#pragma once

#include <string>

namespace alluvium
{
  /**
   * A lock on a folder, by a file in it that the operating system locks: it ends with the process that holds it,
   * however that ends, so that a file left over locks nobody out. File systems that know no locks give none.
   */
  class FolderLock
  {
  public:
    /** Try to lock @p folder. */
    explicit FolderLock(const std::string &folder);
    /** Take lock and file away. */
    ~FolderLock();
    FolderLock(const FolderLock &)            = delete;
    FolderLock &operator=(const FolderLock &) = delete;

    /** Whether another process holds the lock, and who, in words. */
    bool               is_taken() const { return !holder.empty(); }
    const std::string &holder_in_words() const { return holder; }

    /** Who holds the lock of @p folder, in words; empty if nobody does. Changes nothing. */
    static std::string holder_of(const std::string &folder);

  private:
    std::string file_name, holder;
    int         file = -1;
  };
} // namespace alluvium
