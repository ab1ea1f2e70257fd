#include <alluvium/output/summary.h>
#include <alluvium/utilities/atomic_file.h>
#include <alluvium/utilities/first_rank.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/exceptions.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace alluvium::output
{
  namespace
  {
    std::vector<std::string> split(const std::string &path)
    {
      std::vector<std::string> names;
      std::size_t              start = 0;
      for (auto end = path.find('/'); end != std::string::npos; start = end + 1, end = path.find('/', start))
        names.push_back(path.substr(start, end - start));
      names.push_back(path.substr(start));
      return names;
    }

    const nlohmann::ordered_json *find(const nlohmann::ordered_json &root, const std::string &path)
    {
      const nlohmann::ordered_json *node = &root;
      for (const auto &name : split(path))
        {
          if (!node->is_object() || !node->contains(name))
            return nullptr;
          node = &node->at(name);
        }
      return node;
    }
  } // namespace

  Summary::Summary(const std::string &file_name, MPI_Comm communicator)
    : file_name(file_name)
    , is_writer(is_first_rank(communicator))
    , content(std::make_unique<nlohmann::ordered_json>(nlohmann::ordered_json::object()))
  {}

  Summary::~Summary() = default;

  nlohmann::ordered_json &Summary::at(const std::string &path)
  {
    nlohmann::ordered_json *node = content.get();
    for (const auto &name : split(path))
      {
        AssertThrow(node->is_object() || node->is_null(),
                    dealii::ExcMessage("'" + path + "' leads through a value in the summary."));
        node = &(*node)[name];
      }
    return *node;
  }

  // clang-format off
  void Summary::set(const std::string &path, const double value)        { at(path) = value; }
  void Summary::set(const std::string &path, const int value)           { at(path) = value; }
  void Summary::set(const std::string &path, const unsigned int value)  { at(path) = value; }
  void Summary::set(const std::string &path, const unsigned long value) { at(path) = value; }
  void Summary::set(const std::string &path, const bool value)          { at(path) = value; }
  void Summary::set(const std::string &path, const char *value)         { at(path) = value; }
  void Summary::set(const std::string &path, const std::string &value)  { at(path) = value; }
  void Summary::set(const std::string &path, const std::vector<double> &value) { at(path) = value; }
  // clang-format on

  bool Summary::has(const std::string &path) const
  {
    return find(*content, path) != nullptr;
  }

  double Summary::number(const std::string &path) const
  {
    const auto *node = find(*content, path);
    return node != nullptr && node->is_number() ? node->get<double>() : std::numeric_limits<double>::quiet_NaN();
  }

  std::string Summary::text(const std::string &path) const
  {
    const auto *node = find(*content, path);
    return node != nullptr && node->is_string() ? node->get<std::string>() : "";
  }

  void Summary::warn(const std::string &text)
  {
    auto &list = (*content)["warnings"];
    if (std::find(list.begin(), list.end(), text) == list.end())
      list.push_back(text);
  }

  std::vector<std::string> Summary::warnings() const
  {
    return content->value("warnings", std::vector<std::string>{});
  }


  void Summary::clear()
  {
    *content = nlohmann::ordered_json::object();
  }


  void
  Summary::amend(const std::string &file_name, const std::map<std::string, std::string> &texts, const int exit_code)
  {
    try
      {
        Summary summary(file_name, MPI_COMM_SELF);
        if (!std::ifstream(file_name).good())
          return;
        summary.resume();
        for (const auto &[path, text] : texts)
          summary.set(path, text);
        summary.set("exit_code", exit_code);
        summary.write();
      }
    catch (const std::exception &)
      {} // the message on the screen is what counts
  }


  void Summary::write() const
  {
    if (is_writer)
      write_atomically(file_name,
                       content->dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
  }

  void Summary::resume()
  {
    std::ifstream file(file_name); // every rank reads: all may ask for numbers
    if (!file.good())
      return;
    auto read = nlohmann::ordered_json::parse(file, nullptr, false);
    check_user(read.is_object(), "'" + file_name + "' of the interrupted run is not a summary.");
    *content = std::move(read);
  }
} // namespace alluvium::output
