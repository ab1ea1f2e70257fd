#include <alluvium/utilities/checked_file.h>
#include <alluvium/utilities/input_files.h>

#include <algorithm>
#include <fstream>
#include <sstream>

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


  std::string digest_of_file(const std::string &path)
  {
    std::ifstream      in(path, std::ios::binary);
    std::ostringstream all;
    if (!in.good() || !(all << in.rdbuf()))
      return "";
    const std::string  text = all.str();
    std::ostringstream digest;
    digest << text.size() << ' ' << std::hex << crc32(text);
    return digest.str();
  }
} // namespace alluvium
