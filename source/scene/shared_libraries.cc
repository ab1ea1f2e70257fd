#include <alluvium/scene/parameter_file.h>
#include <alluvium/scene/shared_libraries.h>
#include <alluvium/utilities/input_files.h>
#include <alluvium/utilities/plugin.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <filesystem>
#include <fstream>
#include <set>

#include <dlfcn.h>
#include <link.h>

namespace alluvium::scene
{
  namespace
  {
    namespace fs = std::filesystem;

    const std::string libraries_name = "Additional shared libraries";

    /** Files in which the loader found this program's own library: two, if a plug-in was linked with another version.
     */
    std::set<std::string> copies_of_the_program()
    {
      std::set<std::string> copies;
      dl_iterate_phdr(
        [](dl_phdr_info *info, std::size_t, void *found) {
          const std::string path = info->dlpi_name;
          if (fs::path(path).filename().string().find("liballuvium_core.so") == 0)
            static_cast<std::set<std::string> *>(found)->insert(path);
          return 0;
        },
        &copies);
      return copies;
    }

    void load(const fs::path &path)
    {
      const std::string where = libraries_name + ": '" + path.string() + "'";
      std::error_code   ignored;
      check_user(fs::exists(path, ignored), where + ": there is no such file.");
      check_user(std::ifstream(path).good() && !fs::is_directory(path, ignored), where + " cannot be read.");

      // Everything that is missing is missed now, not in the middle of a run. Names of one library hide none of
      // another.
      const unsigned int n_before = n_registered_plugins(), n_taken = names_taken().size();
      void *const        handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
      if (handle == nullptr)
        {
          const char *const reason = dlerror();
          throw UserError(where + " cannot be loaded: " + (reason != nullptr ? reason : "no reason given") +
                          ". It has to be built against this version of Alluvium.");
        }
      const auto copies = copies_of_the_program();
      check_user(copies.size() <= 1,
                 where + " was built against another version of Alluvium: it wants '" +
                   (copies.empty() ? "" : *copies.rbegin()) + "' beside '" + (copies.empty() ? "" : *copies.begin()) +
                   "'. Build it against this one.");
      check_user(names_taken().size() == n_taken,
                 where + " has a plug-in named '" + (names_taken().empty() ? "" : names_taken().back()) +
                   "', and there is one of this name and kind already. Name it otherwise.");
      check_user(n_registered_plugins() > n_before, where + " was loaded, but it registers no plug-in.");
    }

    /** The value that counts: that of the last line, of the command line if it has one. */
    std::string wanted_libraries(const std::string &file_name, const std::vector<std::string> &assignments)
    {
      std::string value;
      if (!file_name.empty())
        for (const Statement &statement : read_statements(file_name))
          if (!statement.opens_section && statement.path == ParameterPath{libraries_name})
            value = statement.value;
      for (const std::string &assignment : assignments)
        {
          const auto equals = assignment.find('=');
          if (equals != std::string::npos && dealii::Utilities::trim(assignment.substr(0, equals)) == libraries_name)
            value = dealii::Utilities::trim(assignment.substr(equals + 1));
        }
      return value;
    }
  } // namespace


  std::string load_shared_libraries(const std::string &file_name, const std::vector<std::string> &assignments)
  {
    static std::set<std::string> loaded;
    const fs::path folder = file_name.empty() ? fs::current_path() : fs::absolute(fs::path(file_name)).parent_path();
    std::string    paths;
    for (const std::string &name : dealii::Utilities::split_string_list(wanted_libraries(file_name, assignments)))
      {
        const fs::path path = (folder / name).lexically_normal();
        if (loaded.count(path.string()) == 0)
          load(path);
        loaded.insert(path.string());
        note_input(path.string());
        paths += (paths.empty() ? "" : ", ") + path.string();
      }
    return paths;
  }


  void declare_shared_libraries(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      libraries_name,
      "",
      dealii::Patterns::Anything(),
      "Files of shared libraries with plug-ins of one's own (drag laws, boundary conditions, observers ...), relative "
      "to "
      "this file and separated by commas. They are loaded before anything else, and their plug-ins are chosen as the "
      "program's own are. doc/developer/plug-ins.md says how to make one.");
  }


  void set_shared_libraries(dealii::ParameterHandler &prm, const std::string &loaded)
  {
    prm.set(libraries_name, loaded);
  }
} // namespace alluvium::scene
