#include <alluvium/utilities/input_files.h>

#include <algorithm>

namespace alluvium
{
  namespace
  {
    std::vector<std::string> &all_inputs()
    {
      static std::vector<std::string> inputs;
      return inputs;
    }
  } // namespace


  void note_input(const std::string &path)
  {
    auto &inputs = all_inputs();
    if (std::find(inputs.begin(), inputs.end(), path) == inputs.end())
      inputs.push_back(path);
  }


  const std::vector<std::string> &noted_inputs()
  {
    return all_inputs();
  }
} // namespace alluvium
