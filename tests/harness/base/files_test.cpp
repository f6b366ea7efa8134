// Where output goes, and what stays unchanged; no text that is read makes the program fail or hang.
#include "harness/base/files.h"

#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "harness/base/json.h"
#include "support/refusal.h"

namespace harness {
namespace {

namespace fs = std::filesystem;

struct Files : testing::Test {
  std::string at(const std::string& name) const { return folder_.file(name); }
  static std::string content(const std::string& path) { return read_file(path, "test"); }

  TemporaryFolder folder_{"files-test"};
};

// A link to a file that does not exist yet does too; both names of an output share one lock.
TEST_F(Files, ALinkStaysALink) {
  fs::create_directory(at("there"));
  std::ofstream(at("there/result.json")) << "old";
  fs::create_symlink("there/result.json", at("link"));
  fs::create_symlink("link", at("second"));
  fs::create_symlink("later.json", at("early"));
  for (const auto& [link, target] :
       {std::pair("second", "there/result.json"), {"early", "later.json"}}) {
    check_writable(at(link));
    write_atomically(at(link), "new");
    EXPECT_TRUE(fs::is_symlink(at(link)));
    EXPECT_EQ(content(at(target)), "new");
    EXPECT_EQ(output_path(at(link)), at(target));
  }
  EXPECT_TRUE(fs::is_symlink(at("link")));
}

TEST_F(Files, LinksInACircleAndFoldersAreRefused) {
  fs::create_symlink("b", at("a"));
  fs::create_symlink("a", at("b"));
  EXPECT_THROW(output_path(at("a")), UsageError);
  EXPECT_THROW(output_path(at("")), UsageError);
  EXPECT_THROW(output_path(""), UsageError);
}

TEST_F(Files, APipeIsWrittenToAndStaysAPipe) {
  ASSERT_EQ(mkfifo(at("pipe").c_str(), 0600), 0);
  std::string got;
  std::thread reader([&] { got = content(at("pipe")); });
  write_atomically(at("pipe"), "through the pipe");
  reader.join();
  EXPECT_EQ(got, "through the pipe");
  EXPECT_TRUE(fs::is_fifo(at("pipe")));
  EXPECT_THROW(regular_output_path(at("pipe")), UsageError);
}

TEST_F(Files, ADeviceStaysADevice) {
  check_writable("/dev/null");
  write_atomically("/dev/null", "text");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THROW(regular_output_path("/dev/null"), UsageError);
  EXPECT_THROW(write_atomically("/dev/full", "text"), FileError);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Files, PermissionsOfAFileThatIsReplacedAreKept) {
  std::ofstream(at("a.json")) << "old";
  ASSERT_EQ(chmod(at("a.json").c_str(), 0640), 0);
  write_atomically(at("a.json"), "new");
  EXPECT_EQ(fs::status(at("a.json")).permissions(), fs::perms(0640));
  const mode_t mask = umask(022);
  write_atomically(at("b.json"), "new");
  umask(mask);
  EXPECT_EQ(fs::status(at("b.json")).permissions(), fs::perms(0644));
}

// Two writers of one file at a time leave one of the two texts, whole, and no other file.
TEST_F(Files, TwoWritersDoNotMix) {
  check_writable(at("f"));
  const std::string a(1 << 16, 'a'), b(1 << 16, 'b');
  for (int i = 0; i < 50; ++i) {
    std::thread other([&] { write_atomically(at("f"), a); });
    write_atomically(at("f"), b);
    other.join();
    const std::string text = content(at("f"));
    EXPECT_TRUE(text == a || text == b);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);
}

TEST(JsonText, InvalidUtf8LosesNoDocument) {
  const json value = {{"path", "a\xffz"}};
  EXPECT_EQ(parse_document(document_text(value), "a.json").at("path"), "a\uFFFDz");
}

TEST(Pattern, MatchesWholeNamesAndFindsParts) {
  const Pattern pattern("--solver", "shake|icd");
  EXPECT_TRUE(pattern.matches("ICD"));
  EXPECT_FALSE(pattern.matches("icd_loose"));
  EXPECT_TRUE(pattern.found_in("chain/icd/n:20"));
}

// With backtracking the first would not end within anybody's time.
TEST(Pattern, PathologicalOnesEndAndHugeOnesAreRefusedInALine) {
  const Pattern pattern("--filter", "(a*)*(a*)*(a*)*b|(a|aa)+$");
  EXPECT_FALSE(pattern.found_in(std::string(5000, 'a') + "c"));
  for (const std::string& bad : {std::string("[z-a]"), std::string(100000, '(')}) {
    const std::string said = refusal_of([&bad] { const Pattern giant("--filter", bad); });
    EXPECT_NE(said, "");
    EXPECT_LT(said.size(), 400u);
  }
}

}  // namespace
}  // namespace harness
