#pragma once

#include <alluvium/mesh/domain.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/grid/tria.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace mesh_test
{
  /** Declare the parameters of @p object and set some of them: "Section/Name" or "Section/Subsection/Name". */
  template <typename Object>
  void set_parameters(Object                                                 &object,
                      dealii::ParameterHandler                               &prm,
                      const std::vector<std::pair<std::string, std::string>> &values)
  {
    object.add_parameters(prm);
    for (const auto &[path, value] : values)
      {
        const auto words = dealii::Utilities::split_string_list(path, '/');
        for (std::size_t i = 0; i + 1 < words.size(); ++i)
          prm.enter_subsection(words[i]);
        prm.set(words.back(), value);
        for (std::size_t i = 0; i + 1 < words.size(); ++i)
          prm.leave_subsection();
      }
  }

  /** Run @p function and give the text of the UserError that it throws. */
  template <typename Function>
  std::string error_of(const Function &function)
  {
    try
      {
        function();
      }
    catch (const alluvium::UserError &error)
      {
        return error.what();
      }
    ADD_FAILURE() << "expected a UserError";
    return "";
  }

  inline bool contains(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }
} // namespace mesh_test
