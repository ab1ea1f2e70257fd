#include <alluvium/utilities/warnings.h>

#include <algorithm>
#include <iostream>
#include <sstream>

#include <unistd.h>

namespace alluvium
{
  void Warnings::add(const std::string &text, const double time, const double count)
  {
    const auto known = std::find_if(list.begin(), list.end(), [&](const Warning &w) { return w.text == text; });
    if (known != list.end())
      {
        known->count += count;
        return;
      }
    list.push_back({text, count, time});
    std::ostringstream said;
    said << text << " (at t = " << time << " s; said once)";
    print(said.str());
  }


  void Warnings::print(const std::string &text) const
  {
    if (is_root)
      std::cerr << (isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "") << "alluvium: warning: " << text << std::endl;
  }


  std::string Warnings::in_words(const Warning &warning)
  {
    std::ostringstream text;
    text << warning.text << " (" << warning.count << (warning.count == 1. ? " time" : " times")
         << ", first at t = " << warning.first_time << " s)";
    return text.str();
  }
} // namespace alluvium
