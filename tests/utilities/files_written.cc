// Files appear whole or not at all, and a folder belongs to one run.
#include <alluvium/utilities/atomic_file.h>
#include <alluvium/utilities/folder_lock.h>
#include <alluvium/utilities/user_error.h>
#include <alluvium/utilities/working_folder.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <unistd.h>

using namespace alluvium;
namespace fs = std::filesystem;

namespace
{
  class FilesWritten : public ::testing::Test
  {
  protected:
    FilesWritten()
      : folder("/tmp/alluvium_written_" + std::to_string(dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, getpid())))
    {
      if (rank == 0)
        {
          fs::remove_all(folder);
          fs::create_directories(folder);
        }
      MPI_Barrier(MPI_COMM_WORLD);
    }

    ~FilesWritten() override
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (rank == 0)
        fs::remove_all(folder);
      MPI_Barrier(MPI_COMM_WORLD);
    }

    static std::string content(const std::string &file)
    {
      std::ifstream      in(file);
      std::ostringstream text;
      text << in.rdbuf();
      return text.str();
    }

    const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                       n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    const std::string folder;
  };
} // namespace

TEST_F(FilesWritten, InTheOrderOfRanks)
{
  const std::string file = folder + "/pieces", mine = "piece " + std::to_string(rank) + "\n";
  std::string       pieces;
  for (unsigned int r = 0; r < n_ranks; ++r)
    pieces += "piece " + std::to_string(r) + "\n";
  write_in_order(MPI_COMM_WORLD, file, "head\n", mine, "tail\n");
  EXPECT_EQ(content(file), "head\n" + pieces + "tail\n");
  write_in_order(MPI_COMM_WORLD, file, "head\n", rank + 1 == n_ranks ? mine : "", "tail\n");
  EXPECT_EQ(content(file), "head\npiece " + std::to_string(n_ranks - 1) + "\ntail\n");
  write_in_order(MPI_COMM_WORLD, file, "head\n", "", "tail\n");
  EXPECT_EQ(content(file), "head\ntail\n");
  EXPECT_FALSE(fs::exists(file + ".tmp"));
  MPI_Barrier(MPI_COMM_WORLD);
}

TEST_F(FilesWritten, AFullDiskIsAUserError)
{
  EXPECT_THROW(write_in_order(MPI_COMM_WORLD, "/no-such-folder/file", "a", "b", "c"), UserError);
  EXPECT_THROW(check_room(MPI_COMM_WORLD, "/no-such-folder/file", 10.), UserError);
  check_room(MPI_COMM_WORLD, folder + "/file", 1e5);
  EXPECT_FALSE(fs::exists(folder + "/file.tmp"));
}

TEST_F(FilesWritten, FolderLock)
{
  if (rank != 0)
    return;
  {
    const FolderLock mine(folder);
    EXPECT_FALSE(mine.is_taken());
    const FolderLock another(folder); // as of another process: locks belong to open files
    EXPECT_TRUE(another.is_taken());
    EXPECT_NE(another.holder_in_words().find("process " + std::to_string(getpid()) + " on "), std::string::npos)
      << another.holder_in_words();
    EXPECT_EQ(FolderLock::holder_of(folder), another.holder_in_words());
  }
  EXPECT_TRUE(fs::is_empty(folder));
  EXPECT_EQ(FolderLock::holder_of(folder), "");

  // what a run that was killed leaves behind locks nobody out
  std::ofstream(folder + "/in-use") << "process 1 on another machine";
  EXPECT_EQ(FolderLock::holder_of(folder), "");
  const FolderLock next(folder);
  EXPECT_FALSE(next.is_taken());
}

TEST_F(FilesWritten, WorkingFolder)
{
  const fs::path before = fs::current_path();
  {
    const WorkingFolder here(folder);
    EXPECT_EQ(fs::current_path(), fs::canonical(folder));
  }
  EXPECT_EQ(fs::current_path(), before);
  EXPECT_THROW(WorkingFolder(folder + "/none"), UserError);
  EXPECT_EQ(fs::current_path(), before);
}
