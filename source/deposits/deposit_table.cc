#include <alluvium/deposits/deposit_table.h>
#include <alluvium/utilities/atomic_file.h>
#include <alluvium/utilities/digits.h>
#include <alluvium/utilities/magnitudes.h>
#include <alluvium/utilities/text_file.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>

#include <unistd.h>

namespace alluvium::deposits
{
  namespace
  {
    struct Column
    {
      const char *name;
      double NewGrain::*member;
      bool              required;
    };

    constexpr std::array<Column, 7> columns = {{{"x", &NewGrain::x, true},
                                                {"y", &NewGrain::y, true},
                                                {"radius", &NewGrain::radius, true},
                                                {"density", &NewGrain::density, false},
                                                {"vx", &NewGrain::vx, false},
                                                {"vy", &NewGrain::vy, false},
                                                {"omega", &NewGrain::omega, false}}};

    std::string_view trim(const std::string_view s)
    {
      const auto first = s.find_first_not_of(" \t\r"), last = s.find_last_not_of(" \t\r");
      return first == std::string_view::npos ? std::string_view() : s.substr(first, last - first + 1);
    }

    void split(const std::string_view line, std::vector<std::string_view> &fields)
    {
      fields.clear();
      std::size_t begin = 0;
      for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',', begin))
        {
          fields.push_back(trim(line.substr(begin, comma - begin)));
          begin = comma + 1;
        }
      fields.push_back(trim(line.substr(begin)));
    }

    /** Reads a table; messages are put together only where something is wrong, for tables have millions of fields. */
    class TableReader
    {
    public:
      TableReader(const std::string &file, const double density)
        : file(file)
        , density(density)
      {}

      std::vector<NewGrain> read(const std::string &text)
      {
        std::vector<std::string_view> fields;
        for (std::size_t begin = 0; begin < text.size(); ++number)
          {
            const std::size_t      end  = std::min(text.find('\n', begin), text.size());
            const std::string_view line = trim(std::string_view(text).substr(begin, end - begin));
            begin                       = end + 1;
            if (line.empty() || line[0] == '#')
              continue;
            split(line, fields);
            if (order.empty())
              read_header(line, fields);
            else
              read_grain(fields);
          }
        check_user(!new_grains.empty(), "The grain file '" + file + "' has no grains.");
        return std::move(new_grains);
      }

    private:
      [[noreturn]] void fail(const std::string &what) const
      {
        throw UserError(file + ", line " + std::to_string(number) + ": " + what);
      }

      void read_header(const std::string_view line, const std::vector<std::string_view> &fields)
      {
        if (fields.size() == 1 && line.find_first_of(";\t") != std::string_view::npos)
          fail("the columns are not separated by commas. A spreadsheet that writes 'x;y;radius' writes decimal commas, "
               "too: save the table as in English.");
        for (const std::string_view field : fields)
          {
            const Column *found = nullptr;
            for (const Column &c : columns)
              if (field == c.name)
                found = &c;
            if (found == nullptr)
              fail("there is no column '" + std::string(field) +
                   "'. The header names columns out of x, y, radius, density, vx, vy, omega.");
            for (const Column *c : order)
              if (c == found)
                fail("column '" + std::string(field) + "' is there twice.");
            order.push_back(found);
          }
        for (const Column &c : columns)
          if (c.required && std::find(order.begin(), order.end(), &c) == order.end())
            fail("the required column '" + std::string(c.name) + "' is missing.");
      }

      void read_grain(const std::vector<std::string_view> &fields)
      {
        if (fields.size() != order.size())
          fail("found " + std::to_string(fields.size()) + " fields, but the header names " +
               std::to_string(order.size()) + " columns.");
        NewGrain seed{};
        seed.density = density;
        for (std::size_t k = 0; k < fields.size(); ++k)
          {
            const auto what = [&] { return std::string(order[k]->name) + " = '" + std::string(fields[k]) + "' "; };
            // behind the field comes a character that no number goes on with, or the text's end
            char        *end   = nullptr;
            const double value = fields[k].empty() ? 0. : std::strtod(fields[k].data(), &end);
            if (fields[k].empty() || end != fields[k].data() + fields[k].size())
              fail(what() + "is not a number.");
            if (!std::isfinite(value))
              fail(what() + "is not a finite number.");
            seed.*(order[k]->member) = value;
          }
        using namespace magnitudes;
        const auto expect = [&](const bool good, const char *what, const double value, const std::string &range) {
          if (!good)
            fail(what + (" = " + alluvium::in_digits(value)) + ": expected " + range + ".");
        };
        if (!(seed.radius > 0.))
          fail("the radius must be positive.");
        if (!(seed.density > 0.))
          fail("the density must be positive.");
        expect(seed.radius >= smallest_length && seed.radius <= largest_length,
               "radius",
               seed.radius,
               "metres, from " + alluvium::in_digits(smallest_length) + " to " + alluvium::in_digits(largest_length));
        expect(seed.density >= 1e-6 && seed.density <= largest_density,
               "density",
               seed.density,
               "kg/m^3, from 1e-06 to " + alluvium::in_digits(largest_density));
        for (const double v : {seed.vx, seed.vy, seed.radius * seed.omega})
          expect(std::abs(v) <= largest_speed,
                 "a velocity",
                 v,
                 "metres per second, at most " + alluvium::in_digits(largest_speed));
        new_grains.push_back(seed);
      }

      const std::string          &file;
      const double                density;
      std::size_t                 number = 1; // of the line
      std::vector<const Column *> order;
      std::vector<NewGrain>       new_grains;
    };
  } // namespace

  std::vector<NewGrain> read_grain_table(const std::string &file, const double density)
  {
    return parse_grain_table(read_text_file(file, "grain file"), file, density);
  }

  std::vector<NewGrain> parse_grain_table(const std::string &text, const std::string &file, const double density)
  {
    return TableReader(file, density).read(text);
  }

  std::string grain_table(const std::vector<NewGrain> &new_grains)
  {
    std::string           text = "x,y,radius,density,vx,vy,omega\n";
    std::array<char, 256> row;
    for (const NewGrain &s : new_grains)
      {
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
        text += row.data();
      }
    return text;
  }

  void write_grain_table(const std::string &file, const std::vector<NewGrain> &new_grains, const std::string &comment)
  {
    std::string        text;
    std::istringstream lines(comment);
    for (std::string line; std::getline(lines, line);)
      text += "# " + line + '\n';
    // two runs may make the same one at the same time
    const std::string mine = file + "." + std::to_string(getpid());
    write_atomically(mine, text + grain_table(new_grains));
    std::error_code error;
    std::filesystem::rename(mine, file, error);
    if (!error)
      return;
    std::remove(mine.c_str());
    throw UserError("cannot write '" + file + "': " + error.message() + ".");
  }

  std::string path_from(const std::string &directory, const std::string &file)
  {
    const std::filesystem::path path(file);
    return path.is_absolute() || directory.empty() ? file : (std::filesystem::path(directory) / path).string();
  }
} // namespace alluvium::deposits
