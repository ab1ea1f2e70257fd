#include <alluvium/grains/deposit_table.h>
#include <alluvium/utilities/user_error.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace alluvium::grains
{
  namespace
  {
    struct Column
    {
      const char *name;
      double Seed::*member;
      bool          required;
    };

    constexpr std::array<Column, 7> columns = {{{"x", &Seed::x, true},
                                                {"y", &Seed::y, true},
                                                {"radius", &Seed::radius, true},
                                                {"density", &Seed::density, false},
                                                {"vx", &Seed::vx, false},
                                                {"vy", &Seed::vy, false},
                                                {"omega", &Seed::omega, false}}};

    std::string trim(const std::string &s)
    {
      const auto first = s.find_first_not_of(" \t\r"), last = s.find_last_not_of(" \t\r");
      return first == std::string::npos ? "" : s.substr(first, last - first + 1);
    }

    std::vector<std::string> split(const std::string &line)
    {
      std::vector<std::string> fields;
      std::size_t              begin = 0;
      for (std::size_t comma = line.find(','); comma != std::string::npos; comma = line.find(',', begin))
        {
          fields.push_back(trim(line.substr(begin, comma - begin)));
          begin = comma + 1;
        }
      fields.push_back(trim(line.substr(begin)));
      return fields;
    }
  } // namespace

  std::vector<Seed> read_grain_table(const std::string &file, const double density)
  {
    std::ifstream in(file);
    check_user(in.good(), "Cannot open the grain file '" + file + "'.");

    std::vector<Seed>           seeds;
    std::vector<const Column *> order;
    std::string                 line;
    for (unsigned int number = 1; std::getline(in, line); ++number)
      {
        const std::string where = file + ", line " + std::to_string(number) + ": ";
        line                    = trim(line);
        if (line.empty() || line[0] == '#')
          continue;
        const std::vector<std::string> fields = split(line);

        if (order.empty()) // the header
          {
            for (const std::string &field : fields)
              {
                const Column *found = nullptr;
                for (const Column &c : columns)
                  if (field == c.name)
                    found = &c;
                check_user(found != nullptr,
                           where + "there is no column '" + field +
                             "'. The header names columns out of x, y, radius, density, vx, vy, omega.");
                for (const Column *c : order)
                  check_user(c != found, where + "column '" + field + "' is there twice.");
                order.push_back(found);
              }
            for (const Column &c : columns)
              {
                bool found = false;
                for (const Column *o : order)
                  found = found || o == &c;
                check_user(found || !c.required,
                           where + "the required column '" + std::string(c.name) + "' is missing.");
              }
            continue;
          }

        check_user(fields.size() == order.size(),
                   where + "found " + std::to_string(fields.size()) + " fields, but the header names " +
                     std::to_string(order.size()) + " columns.");
        Seed seed{};
        seed.density = density;
        for (std::size_t k = 0; k < fields.size(); ++k)
          {
            char        *end   = nullptr;
            const double value = std::strtod(fields[k].c_str(), &end);
            const auto   what  = where + order[k]->name + " = '" + fields[k] + "' ";
            check_user(!fields[k].empty() && *end == '\0', what + "is not a number.");
            check_user(std::isfinite(value), what + "is not a finite number.");
            seed.*(order[k]->member) = value;
          }
        check_user(seed.radius > 0., where + "the radius must be positive.");
        check_user(seed.density > 0., where + "the density must be positive.");
        seeds.push_back(seed);
      }
    check_user(!seeds.empty(), "The grain file '" + file + "' has no grains.");
    return seeds;
  }

  void write_grain_table(const std::string &file, const std::vector<Seed> &seeds, const std::string &comment)
  {
    const std::string unfinished = file + ".unfinished";
    {
      std::ofstream      out(unfinished);
      std::istringstream lines(comment);
      for (std::string line; std::getline(lines, line);)
        out << "# " << line << '\n';
      out << "x,y,radius,density,vx,vy,omega\n";
      for (const Seed &s : seeds)
        {
          std::array<char, 256> row;
          std::snprintf(row.data(),
                        row.size(),
                        "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n",
                        s.x,
                        s.y,
                        s.radius,
                        s.density,
                        s.vx,
                        s.vy,
                        s.omega);
          out << row.data();
        }
      out.flush();
      check_user(out.good(), "Cannot write the grain file '" + unfinished + "'.");
    }
    std::error_code error;
    std::filesystem::rename(unfinished, file, error);
    check_user(!error, "Cannot write the grain file '" + file + "': " + error.message() + ".");
  }

  std::string path_from(const std::string &directory, const std::string &file)
  {
    const std::filesystem::path path(file);
    return path.is_absolute() || directory.empty() ? file : (std::filesystem::path(directory) / path).string();
  }
} // namespace alluvium::grains
