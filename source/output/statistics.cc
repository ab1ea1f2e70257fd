#include <alluvium/output/statistics.h>
#include <alluvium/utilities/atomic_file.h>
#include <alluvium/utilities/first_rank.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <sstream>

namespace alluvium::output
{
  Statistics::Statistics(const std::string &file_name, MPI_Comm communicator, const unsigned int precision)
    : file_name(file_name)
    , communicator(communicator)
    , precision(precision)
    , is_writer(is_first_rank(communicator))
  {}

  void Statistics::add_column(const std::string &name)
  {
    AssertThrow(!is_started, dealii::ExcMessage("Column '" + name + "' comes after the first row."));
    AssertThrow(std::find(columns.begin(), columns.end(), name) == columns.end(),
                dealii::ExcMessage("There are two columns '" + name + "'."));
    AssertThrow(name.find_first_of(",\"\n") == std::string::npos,
                dealii::ExcMessage("'" + name + "' cannot name a column of a .csv file."));
    columns.push_back(name);
    row.emplace_back();
  }

  std::size_t Statistics::place_of(const std::string &column) const
  {
    const auto place = std::find(columns.begin(), columns.end(), column);
    AssertThrow(place != columns.end(), dealii::ExcMessage("There is no column '" + column + "'."));
    return place - columns.begin();
  }

  void Statistics::set(const std::string &column, const double value)
  {
    row[place_of(column)] = formatted(value);
  }

  void Statistics::set(const std::string &column, const std::string &word)
  {
    AssertThrow(word.find_first_of(",\"\n") == std::string::npos,
                dealii::ExcMessage("'" + word + "' cannot stand in a .csv file."));
    row[place_of(column)] = word;
  }

  void Statistics::write_row()
  {
    if (!is_started)
      open(false);
    int problem = 0; // errno
    if (is_writer)
      {
        for (std::size_t i = 0; i < row.size(); ++i)
          file << (i == 0 ? "" : ",") << row[i];
        errno = 0;
        file << '\n' << std::flush;
        problem = file.good() ? 0 : std::max(errno, 1);
      }
    MPI_Bcast(&problem, 1, MPI_INT, 0, communicator);
    check_user(problem == 0, "cannot write '" + file_name + "': " + std::strerror(problem) + ".");
    std::fill(row.begin(), row.end(), "");
  }

  void Statistics::resume(const double time)
  {
    AssertThrow(!is_started, dealii::ExcMessage("resume() comes before the first row."));
    on_first_rank(communicator, [&] {
      std::ifstream old(file_name);
      check_user(old.good(), "cannot read '" + file_name + "' to continue it: " + std::strerror(errno) + ".");
      std::string line, kept;
      std::getline(old, line);
      const std::size_t n_old = take_columns_of(line);
      kept                    = header() + '\n';
      const std::string added(columns.size() - n_old, ',');

      // Compare with the time as it was written: rounding may have taken it past the given one.
      const double last = std::strtod(formatted(time).c_str(), nullptr);
      while (std::getline(old, line))
        {
          const bool is_whole = !old.eof() && std::count(line.begin(), line.end(), ',') + 1 == long(n_old);
          if (!is_whole || std::strtod(line.c_str(), nullptr) > last)
            break;
          kept += line + added + '\n';
        }
      old.close();
      write_atomically(file_name, kept);
    });
    open(true);
  }

  void Statistics::open(const bool append)
  {
    is_started = true;
    on_first_rank(communicator, [&] {
      file.open(file_name, append ? std::ios::app : std::ios::trunc);
      if (!append)
        file << header() << '\n' << std::flush;
      check_user(file.good(), "cannot write '" + file_name + "': " + std::strerror(errno) + ".");
    });
  }

  /** Those of the old header @p line first, also those that are no longer filled; returns their number. */
  std::size_t Statistics::take_columns_of(const std::string &line)
  {
    std::vector<std::string> all;
    std::istringstream       names(line);
    for (std::string name; std::getline(names, name, ',');)
      all.push_back(name);
    check_user(!all.empty() && all[0] == columns[0],
               "'" + file_name + "' does not begin with the column '" + columns[0] +
                 "': it is not what the interrupted run has written.");
    const std::size_t n_old = all.size();
    for (const auto &column : columns)
      if (std::find(all.begin(), all.end(), column) == all.end())
        all.push_back(column);
    columns = all;
    row.assign(columns.size(), "");
    return n_old;
  }

  std::string Statistics::header() const
  {
    std::string text;
    for (const auto &column : columns)
      text += (text.empty() ? "" : ",") + column;
    return text;
  }

  std::string Statistics::formatted(const double value) const
  {
    if (std::isnan(value))
      return "";
    char text[50];
    std::snprintf(text, sizeof(text), "%.*g", int(precision), value == 0. ? 0. : value); // no -0
    return text;
  }

  std::map<std::string, std::string> names_in_columns(const std::vector<std::string> &names,
                                                      const std::string              &unwanted)
  {
    std::map<std::string, std::string> result;
    std::set<std::string>              taken;
    for (const std::string &name : names)
      {
        if (result.count(name) > 0)
          continue;
        std::string word = name;
        for (char &c : word)
          if ((",\"\n" + unwanted).find(c) != std::string::npos)
            c = '_';
        std::string free = word;
        for (unsigned int n = 2; taken.count(free) > 0; ++n)
          free = word + "_" + std::to_string(n);
        taken.insert(free);
        result[name] = free;
      }
    return result;
  }
} // namespace alluvium::output
