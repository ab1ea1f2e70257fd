#pragma once

#include <memory>
#include <string>

namespace alluvium
{
  /**
   * Keeps what goes through std::cout and std::cerr while it lives and, once it knows a file, writes it there line by
   * line. Of a progress bar only the last state of each line is kept.
   */
  class Log
  {
  public:
    /** Only what std::cerr gets if @p errors_only: ranks other than the first. */
    explicit Log(bool errors_only);
    ~Log();
    Log(const Log &)            = delete;
    Log &operator=(const Log &) = delete;

    /**
     * Write to @p file_name from now on, first @p headline, then what has been kept. Starts the file anew unless @p
     * append. A disk that does not take it is no error: the screen has it all. Without a Log this does nothing.
     */
    static void open(const std::string &file_name, const std::string &headline, bool append);

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation;
    static Log                     *instance;
  };
} // namespace alluvium
