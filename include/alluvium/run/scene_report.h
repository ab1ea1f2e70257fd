#pragma once

#include <iosfwd>
#include <string>

namespace alluvium::run
{
  struct Model;

  /** What the scene is, room by room, and what it leaves out; @p observers is the line on those. */
  void report_scene(const Model &model, const std::string &observers, std::ostream &out);
} // namespace alluvium::run
