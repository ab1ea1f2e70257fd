#include <alluvium/deposits/deposit_cache.h>
#include <alluvium/deposits/deposit_table.h>
#include <alluvium/utilities/checked_file.h>
#include <alluvium/utilities/text_file.h>
#include <alluvium/utilities/user_error.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <sstream>

namespace alluvium::deposits
{
  namespace
  {
    /** FNV-1a: short, and the same everywhere. */
    std::string hash(const std::string &text)
    {
      std::uint64_t h = 14695981039346656037ull;
      for (const unsigned char c : text)
        h = (h ^ c) * 1099511628211ull;
      char digits[17];
      std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(h));
      return digits;
    }

    std::string as_comment(const std::string &lines)
    {
      std::istringstream in(lines);
      std::string        result;
      for (std::string line; std::getline(in, line);)
        result += "# " + line + '\n';
      return result;
    }

    std::string contents(const std::size_t n_grains, const std::string &table)
    {
      std::ostringstream text;
      text << "contents: " << n_grains << " grains, checksum " << std::hex << crc32(table) << '\n';
      return text.str();
    }
  } // namespace


  DepositCache::DepositCache(const std::string &folder, const std::string &recipe)
    : folder(folder)
    , recipe(recipe)
    , file(folder + "/settled_bed_" + hash(recipe) + ".csv")
  {}


  bool DepositCache::read(std::vector<NewGrain> &new_grains, std::string &remark) const
  {
    std::error_code error;
    if (!std::filesystem::exists(file, error))
      return false;
    try
      {
        const std::string text = read_text_file(file, "settled bed"), made_by = as_comment(recipe);
        const auto        table = text.find("\nx,");
        if (text.compare(0, made_by.size(), made_by) == 0 && table != std::string::npos)
          {
            const std::string rows  = text.substr(table + 1);
            const auto        n     = std::count(rows.begin(), rows.end(), '\n') - 1;
            const std::string whole = as_comment(contents(n, rows));
            if (table + 1 >= whole.size() && text.compare(table + 1 - whole.size(), whole.size(), whole) == 0)
              {
                new_grains = parse_grain_table(text, file, 0.);
                return true;
              }
          }
        remark = "The settled bed in '" + file + "' is cut off or was altered: it is made anew.";
      }
    catch (const UserError &complaint)
      {
        remark = std::string("The settled bed that was kept is made anew. ") + complaint.what();
      }
    new_grains.clear();
    return false;
  }


  void DepositCache::write(const std::vector<NewGrain> &new_grains, const std::string &measured) const
  {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    check_user(!error, "Cannot make the folder '" + folder + "': " + error.message() + ".");
    write_grain_table(file, new_grains, recipe + measured + contents(new_grains.size(), grain_table(new_grains)));
  }
} // namespace alluvium::deposits
