#include <alluvium/utilities/checked_file.h>
#include <alluvium/utilities/input_files.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace alluvium
{
  namespace
  {
    std::vector<InputFile> &all_inputs()
    {
      static std::vector<InputFile> inputs;
      return inputs;
    }
  } // namespace


  void note_input(const std::string &path, const std::string &digest)
  {
    auto      &inputs = all_inputs();
    const auto known =
      std::find_if(inputs.begin(), inputs.end(), [&](const InputFile &input) { return input.path == path; });
    if (known == inputs.end())
      inputs.push_back({path, digest});
    else if (!digest.empty())
      known->digest = digest;
  }


  const std::vector<InputFile> &noted_inputs()
  {
    return all_inputs();
  }


  std::string digest_of(const std::string &content)
  {
    std::ostringstream digest;
    digest << content.size() << ' ' << std::hex << crc32(content);
    return digest.str();
  }


  std::string digest_of_file(const std::string &path)
  {
    std::ifstream      in(path, std::ios::binary);
    std::ostringstream all;
    if (!in.good() || !(all << in.rdbuf()))
      return "";
    return digest_of(all.str());
  }
} // namespace alluvium
