#pragma once

#include <alluvium/contacts/rest.h>
#include <alluvium/contacts/search/contact_archive.h>

#include <optional>

namespace alluvium::contacts
{
  /** What ContactStepper::advance() changes besides the grains: with it, a step can be taken back and tried again. */
  struct ContactMemory
  {
    std::vector<double>           wall_positions;
    Rest                          rest;
    std::optional<ContactArchive> history; // where contacts have one: bonds, springs
  };
} // namespace alluvium::contacts
