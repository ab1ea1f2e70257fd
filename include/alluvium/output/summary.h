#pragma once

#include <mpi.h>

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace alluvium::output
{
  /**
   * What a run comes to: summary.json, nested objects of numbers and texts and a list of warnings. Rank 0 writes; all
   * ranks may call everything. Names end in their SI unit: set("timing/fluid solve_s", 12.3).
   */
  class Summary
  {
  public:
    Summary(const std::string &file_name, MPI_Comm communicator);
    ~Summary();

    /** Set what @p path ('a/b/c') leads to, making the objects on the way; a not finite number becomes null. */
    void set(const std::string &path, double value);
    void set(const std::string &path, int value);
    void set(const std::string &path, unsigned int value);
    void set(const std::string &path, unsigned long value);
    void set(const std::string &path, bool value);
    void set(const std::string &path, const char *value);
    void set(const std::string &path, const std::string &value);
    void set(const std::string &path, const std::vector<double> &value);

    bool has(const std::string &path) const;

    /** The number at @p path; NaN if there is none. */
    double number(const std::string &path) const;

    /** The text at @p path; empty if there is none. */
    std::string text(const std::string &path) const;

    /** Add to the list "warnings", each text once. */
    void                     warn(const std::string &text);
    std::vector<std::string> warnings() const;

    /** Begin anew. */
    void clear();

    /**
     * Change the file that another rank has written: texts and numbers by their paths. For a rank that fails alone.
     * Does nothing where there is no file, and throws nothing.
     */
    static void amend(const std::string &file_name, const std::map<std::string, std::string> &texts, int exit_code);

    /** Write the file, atomically; as often as wanted. */
    void write() const;

    /** Start from what an interrupted run has left. A missing file is no error. */
    void resume();

  private:
    nlohmann::ordered_json &at(const std::string &path);

    const std::string                       file_name;
    const bool                              is_writer;
    std::unique_ptr<nlohmann::ordered_json> content;
  };
} // namespace alluvium::output
