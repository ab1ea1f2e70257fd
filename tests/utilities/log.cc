#include <alluvium/utilities/log.h>
#include <alluvium/utilities/warnings.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>

using namespace alluvium;

namespace
{
  std::string content(const std::string &file_name)
  {
    std::ifstream      file(file_name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
} // namespace

TEST(Log, HasBothStreamsFromTheBeginning)
{
  const std::string name = testing::TempDir() + "alluvium-log.txt";
  std::remove(name.c_str());
  {
    const Log log(false);
    std::cout << "before" << std::endl;
    Log::open(name, "head", false);
    std::cerr << "error " << 1 << std::endl;
    std::cout << "\r[=   ] 10 %\033[K" << std::flush;
    std::cout << "\r[==  ] 20 %\033[K" << std::flush << std::endl;
    std::cout << "no end";
  }
  EXPECT_EQ(content(name), "head\nbefore\nerror 1\n[==  ] 20 %\nno end\n");
  {
    const Log log(false);
    Log::open(name, "again", true);
  }
  EXPECT_EQ(content(name), "head\nbefore\nerror 1\n[==  ] 20 %\nno end\nagain\n");
  {
    const Log log(true); // another rank
    Log::open(name, "", true);
    std::cout << "not this" << std::endl;
    std::cerr << "but this" << std::endl;
  }
  EXPECT_NE(content(name).find("again\nbut this\n"), std::string::npos);
  EXPECT_EQ(content(name).find("not this"), std::string::npos);
}

TEST(Warnings, AreSaidOnceAndCounted)
{
  Warnings              warnings(true);
  std::ostringstream    screen;
  std::streambuf *const before = std::cerr.rdbuf(screen.rdbuf());
  warnings.add("loose", 0.5);
  warnings.add("loose", 0.75, 3.);
  warnings.add("tight", 1.);
  std::cerr.rdbuf(before);
  ASSERT_EQ(warnings.all().size(), 2u);
  EXPECT_EQ(Warnings::in_words(warnings.all()[0]), "loose (4 times, first at t = 0.5 s)");
  EXPECT_EQ(Warnings::in_words(warnings.all()[1]), "tight (1 time, first at t = 1 s)");
  const std::string text = screen.str();
  EXPECT_EQ(text.find("loose"), text.rfind("loose"));
  EXPECT_NE(text.find("alluvium: warning: loose (at t = 0.5 s; said once)\n"), std::string::npos);
}
