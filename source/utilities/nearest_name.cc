#include <alluvium/utilities/nearest_name.h>

#include <algorithm>
#include <cctype>

namespace alluvium
{
  namespace
  {
    std::string lower(std::string text)
    {
      std::transform(text.begin(), text.end(), text.begin(), [](const unsigned char c) { return std::tolower(c); });
      return text;
    }
  } // namespace

  unsigned int edit_distance(const std::string &first, const std::string &second)
  {
    const std::string a = lower(first), b = lower(second);

    // Three rows of the Damerau-Levenshtein table (optimal string alignment).
    std::vector<unsigned int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
      row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
      {
        before.swap(last);
        last.swap(row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j)
          {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
              row[j] = std::min(row[j], before[j - 2] + 1);
          }
      }
    return row[b.size()];
  }

  std::string nearest_name(const std::string &name, const std::vector<std::string> &candidates)
  {
    std::string  nearest;
    unsigned int smallest = name.size() + 1;
    for (const auto &candidate : candidates)
      {
        const unsigned int distance = edit_distance(name, candidate);
        if (distance < smallest)
          {
            smallest = distance;
            nearest  = candidate;
          }
      }
    if (smallest <= std::max<std::size_t>(2, name.size() / 3) && smallest < name.size())
      return nearest;

    // A part of a name, such as 'density' for 'Grain density', is far in edits but no less clear if it fits only one.
    if (name.size() >= 4)
      {
        std::vector<std::string> holding;
        for (const auto &candidate : candidates)
          if (lower(candidate).find(lower(name)) != std::string::npos)
            holding.push_back(candidate);
        if (holding.size() == 1)
          return holding.front();
      }
    return {};
  }
} // namespace alluvium
