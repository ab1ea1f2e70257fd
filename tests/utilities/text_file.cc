#include <alluvium/utilities/input_files.h>
#include <alluvium/utilities/text_file.h>
#include <alluvium/utilities/user_error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <unistd.h>

using namespace alluvium;

namespace
{
  std::string text_of(const std::string &bytes)
  {
    const std::string file = "/tmp/alluvium_text_" + std::to_string(getpid());
    std::ofstream(file, std::ios::binary) << bytes;
    std::string result;
    try
      {
        result = read_text_file(file, "table");
      }
    catch (const UserError &error)
      {
        result = std::string("error: ") + error.what();
      }
    std::filesystem::remove(file);
    return result;
  }

  bool contains(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }

  TEST(TextFile, Utf8IsKnown)
  {
    for (const char *text : {"", "plain", "gr\xC3\xBC\xC3\x9F", "\xE2\x82\xAC", "\xF0\x9F\x8C\x8A"})
      EXPECT_TRUE(alluvium::is_utf8(text)) << text;
    for (const char *text :
         {"gr\xFC\xDF", "\xC3", "\xC0\xAF", "\xE2\x82", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\x80", "\xFF"})
      EXPECT_FALSE(alluvium::is_utf8(text)) << text;
  }
} // namespace

TEST(TextFile, ByteOrderMarks)
{
  EXPECT_EQ(text_of("x,y\n1,2\n"), "x,y\n1,2\n");
  EXPECT_EQ(text_of("\xEF\xBB\xBFx,y\n1,2\n"), "x,y\n1,2\n");
  EXPECT_EQ(text_of("\xEF\xBB\xBF"), "");
  EXPECT_EQ(text_of(""), "");
  EXPECT_TRUE(contains(text_of(std::string("\xFF\xFEx\0,\0", 6)), "saved as UTF-16"));
  EXPECT_TRUE(contains(text_of(std::string("\xFE\xFF\0x\0,", 6)), "saved as UTF-16"));
}

TEST(TextFile, OtherThings)
{
  EXPECT_EQ(text_of("x,y\r1,2\r"), "x,y\n1,2\n");
  EXPECT_EQ(text_of("x,y\r\n1,2\r\n"), "x,y\r\n1,2\r\n"); // whoever reads lines trims them
  EXPECT_TRUE(contains(text_of(std::string("PK\0\0", 4)), "is no text"));
  for (const auto &[path, what] : {std::make_pair("/tmp", "The table '/tmp' is a folder."),
                                   std::make_pair("/no-such-file", "There is no table '/no-such-file'.")})
    try
      {
        read_text_file(path, "table");
        FAIL();
      }
    catch (const UserError &error)
      {
        EXPECT_STREQ(error.what(), what);
      }
}

TEST(TextFile, ChecksumIsKeptFromTheFirstReading)
{
  const std::string file = "/tmp/alluvium_checksum_" + std::to_string(getpid());
  std::ofstream(file, std::ios::binary) << "\xEF\xBB\xBFx,y\n1,2\n";
  const std::string digest = digest_of_file(file);
  read_text_file(file, "table");
  std::filesystem::remove(file);
  const auto noted = std::find_if(
    noted_inputs().begin(), noted_inputs().end(), [&](const InputFile &input) { return input.path == file; });
  ASSERT_NE(noted, noted_inputs().end());
  EXPECT_EQ(noted->digest, digest);
  EXPECT_FALSE(digest.empty());
}
