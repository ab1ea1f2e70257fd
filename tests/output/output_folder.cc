#include <alluvium/output/output_folder.h>
#include <alluvium/utilities/input_files.h>
#include <alluvium/utilities/user_error.h>

#include <deal.II/base/parameter_handler.h>

#include "fixtures/folder_fixture.h"

using alluvium::UserError;
using alluvium::output::OutputFolder;

namespace
{
  class OutputFolderTest : public FolderFixture
  {
  protected:
    /** Create @p name and return what is complained about. */
    std::string create(const std::string &name, const bool may_overwrite = false, const bool is_restart = false)
    {
      OutputFolder             output;
      dealii::ParameterHandler prm;
      output.add_parameters(prm);
      prm.set("Output folder", name[0] == '/' ? name : path(name));
      prm.set("Overwrite output folder", may_overwrite);
      return complaint<UserError>([&] { output.create(MPI_COMM_WORLD, is_restart); });
    }

    bool contains(const std::string &text, const std::string &part) { return text.find(part) != std::string::npos; }
  };
} // namespace

TEST_F(OutputFolderTest, IsMade)
{
  EXPECT_EQ(create("new/"), "");
  EXPECT_TRUE(std::filesystem::is_directory(path("new")));
  EXPECT_EQ(create("new"), ""); // empty: may be used
}

TEST_F(OutputFolderTest, NeedsItsParent)
{
  EXPECT_TRUE(contains(create("a/b"), "there is no folder '" + path("a") + "'"));
  EXPECT_EQ(n_files(), 0u);
  EXPECT_TRUE(contains(create("/proc/alluvium"), "cannot be made"));
}

TEST_F(OutputFolderTest, IsNoFile)
{
  write("file", "");
  EXPECT_TRUE(contains(create("file"), "is a file"));
}

TEST_F(OutputFolderTest, KeepsAnOlderRun)
{
  for (const std::string name : {"statistics.csv", "parameters.prm"})
    {
      std::filesystem::create_directory(path("old"));
      write("old/" + name, "precious");
      EXPECT_TRUE(contains(create("old"), "holds an older run"));
      EXPECT_EQ(read("old/" + name), "precious");
      std::filesystem::remove_all(path("old"));
    }
}

TEST_F(OutputFolderTest, OverwritesWhatARunWroteAndNothingElse)
{
  std::filesystem::create_directory(path("old"));
  std::filesystem::create_directory(path("old/kept.vtu"));
  std::filesystem::create_directory(path("old/checkpoint"));
  for (const std::string name : {"statistics.csv", "grains-0001.vtu", "checkpoint/state", "notes.txt"})
    write("old/" + name, "text");
  EXPECT_EQ(create("old", true), "");
  EXPECT_FALSE(std::filesystem::exists(path("old/statistics.csv")));
  EXPECT_FALSE(std::filesystem::exists(path("old/grains-0001.vtu")));
  EXPECT_FALSE(std::filesystem::exists(path("old/checkpoint")));
  EXPECT_TRUE(std::filesystem::exists(path("old/notes.txt")));
  EXPECT_TRUE(std::filesystem::exists(path("old/kept.vtu")));
}

TEST_F(OutputFolderTest, KeepsWhatOnlyHasACheckpointsName)
{
  std::filesystem::create_directory(path("old"));
  std::filesystem::create_directory(path("old/checkpoint"));
  write("old/statistics.csv", "text");
  write("old/checkpoint/state", "text");
  write("old/checkpoint/notes", "precious");
  EXPECT_TRUE(contains(create("old", true), "holds 'checkpoint', which no run has written"));
  EXPECT_EQ(read("old/checkpoint/notes"), "precious");
  EXPECT_EQ(read("old/statistics.csv"), "text");
  std::filesystem::create_directory(path("new"));
  write("new/checkpoint-notes", "precious");
  EXPECT_TRUE(contains(create("new"), "holds 'checkpoint-notes'"));
}

TEST_F(OutputFolderTest, RestartsInPlace)
{
  EXPECT_TRUE(contains(create("old", false, true), "to restart from"));
  std::filesystem::create_directory(path("old"));
  write("old/statistics.csv", "precious");
  EXPECT_EQ(create("old", true, true), "");
  EXPECT_EQ(read("old/statistics.csv"), "precious");
}

TEST_F(OutputFolderTest, DoesNotReplaceWhatTheRunReads)
{
  std::filesystem::create_directory(path("old"));
  write("old/parameters.prm", "precious");
  write("old/mine.csv", "precious, too");
  std::filesystem::create_directory_symlink(path("old"), path("link"));
  alluvium::note_input(path("link/../link/parameters.prm"));
  alluvium::note_input(path("old/mine.csv"));
  EXPECT_TRUE(contains(create("old", true), "holds 'parameters.prm', which this run reads"));
  EXPECT_TRUE(contains(create("link", true), "holds 'parameters.prm', which this run reads"));
  EXPECT_EQ(read("old/parameters.prm"), "precious");
  EXPECT_EQ(create("old", false, true), ""); // a restart goes on with what is there
  std::filesystem::remove(path("old/parameters.prm"));
  write("old/statistics.csv", "");
  EXPECT_EQ(create("old", true), "");
  EXPECT_EQ(read("old/mine.csv"), "precious, too");
}
