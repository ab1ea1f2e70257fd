#pragma once

#include <mpi.h>

#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace alluvium::output
{
  /**
   * The numbers of a run over time: a .csv file with a header line and one row for each write_row(), flushed at once so
   * that it can be plotted while the run goes on. All ranks may call everything; rank 0 writes.
   *
   * Names of columns end in their SI unit: "time_s", "differential_head_m". The first one is the time.
   */
  class Statistics
  {
  public:
    /** @p precision is the number of significant digits. */
    Statistics(const std::string &file_name, MPI_Comm communicator, unsigned int precision = 10);

    /** Add a column; an error after the first row, or if there is one of this name. */
    void add_column(const std::string &name);

    void set(const std::string &column, double value);
    /** A word, without comma and quotation mark. */
    void set(const std::string &column, const std::string &word);

    /** Write what was set since the last row; columns that were not are left empty. Collective. */
    void write_row();

    /**
     * Continue the file of an interrupted run: keep its rows up to @p time, drop the later ones (and a torn last line).
     * Columns that the file does not have come after its own and are empty in its rows; those that only the file has
     * stay, empty from now on. To be called after all columns were added and before the first row.
     */
    void resume(double time);

  private:
    void        open(bool append);
    std::size_t take_columns_of(const std::string &line);
    std::string header() const;
    std::size_t place_of(const std::string &column) const;
    std::string formatted(double value) const;

    const std::string        file_name;
    const MPI_Comm           communicator;
    const unsigned int       precision;
    const bool               is_writer;
    bool                     is_started = false;
    std::vector<std::string> columns;
    std::vector<std::string> row; // as written; empty: not set
    std::ofstream            file;
  };

  /**
   * What columns call things of the given @p names, each once: characters that are among @p unwanted become `_`, as do
   * commas and quotation marks, and where two would be called the same, the later one gets a number.
   */
  std::map<std::string, std::string> names_in_columns(const std::vector<std::string> &names,
                                                      const std::string              &unwanted = "");
} // namespace alluvium::output
