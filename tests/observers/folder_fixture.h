#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <unistd.h>

/** A temporary folder for a test to write in. */
class FolderFixture : public ::testing::Test
{
protected:
  FolderFixture()
    : folder(std::filesystem::temp_directory_path() / ("alluvium-observers-" + std::to_string(getpid())))
  {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }

  ~FolderFixture() override { std::filesystem::remove_all(folder); }

  std::string path(const std::string &name) const { return (folder / name).string(); }

  std::string read(const std::string &name) const
  {
    std::ifstream     file(path(name));
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }

  void write(const std::string &name, const std::string &text) const { std::ofstream(path(name)) << text; }

  unsigned int n_files() const
  {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  }

  std::filesystem::path folder;
};

/** What @p function complains about, or an empty string. */
template <class Error, class Function>
std::string complaint(const Function &function)
{
  try
    {
      function();
    }
  catch (const Error &error)
    {
      return error.what();
    }
  return "";
}
