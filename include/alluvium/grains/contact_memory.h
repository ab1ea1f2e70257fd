#pragma once

#include <alluvium/grains/contact_archive.h>
#include <alluvium/grains/rest.h>

#include <optional>

namespace alluvium::grains
{
  /** What ContactStepper::advance() changes besides the grains: with it, a step can be taken back and tried again. */
  struct ContactMemory
  {
    std::vector<double>           wall_positions;
    Rest                          rest;
    std::optional<ContactArchive> history; // where contacts have one: bonds, springs
  };
} // namespace alluvium::grains
