#pragma once

#include <string>
#include <vector>

namespace alluvium
{
  /**
   * What a run warns of: each text once, with how often it was found and the first time. All ranks may call everything;
   * the first one prints them.
   */
  class Warnings
  {
  public:
    explicit Warnings(const bool is_root)
      : is_root(is_root)
    {}

    struct Warning
    {
      std::string text;
      double      count;
      double      first_time; // [s]
    };

    /** @p text was true @p count times at @p time [s]; the first time it is printed on standard error. */
    void add(const std::string &text, double time, double count = 1.);

    /** Print @p text on standard error, without keeping it. */
    void print(const std::string &text) const;

    const std::vector<Warning> &all() const { return list; }
    void                        set(std::vector<Warning> warnings) { list = std::move(warnings); }

    /** Text, count and first time in one sentence. */
    static std::string in_words(const Warning &warning);

  private:
    const bool           is_root;
    std::vector<Warning> list;
  };
} // namespace alluvium
