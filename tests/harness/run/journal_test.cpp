// Journals and pieces: however a sweep is divided, its parts make up the whole.
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "harness/points/result_file.h"
#include "harness/run/fake_machine.h"

namespace harness {
namespace {

// Two scenes, two limits, three sizes: 60 searches of up to ten steps.
Suite suite_of(const std::string& axis) {
  json sweeps = json::array();
  for (const auto& [scene, sizes] :
       std::map<std::string, std::vector<int>>{{"chain", {5, 7, 9}}, {"drape", {5, 7}}}) {
    sweeps.push_back({{"scene", scene},
                      {"sweep", axis},
                      {"solvers", {"shake", "icd"}},
                      {"steps", {{"finest", 0.002}}}});
    sweeps.back().update(axis == "strain"
                             ? json{{"limits", {0.1, 0.01}}, {"scene_parameters", {{"n", 7}}}}
                             : json{{"limit", 0.01}, {"resolutions", sizes}});
  }
  const json suite = {{"name", "test"}, {"seed", 3}, {"reps", 3}, {"sweeps", sweeps}};
  return parse_suite(suite.dump(), "test");
}

// Times depend only on what is run; some runs fail.
FakeMachine hashing_machine() {
  const auto hash = [](const PointSpec& spec) { return std::hash<std::string>{}(key_of(spec)); };
  FakeMachine machine{
      [hash](const PointSpec& spec) { return 1 + static_cast<double>(hash(spec) % 1000); }};
  machine.status = [hash](const PointSpec& spec) {
    return hash(spec) % 5 == 0 ? PointStatus::not_converged : PointStatus::ok;
  };
  machine.again = [](const PointResult& point) { return point.samples.back() + 0.25; };
  return machine;
}

json points_json(const std::vector<PointResult>& points) {
  json list = json::array();
  for (const PointResult& point : points) list.push_back(to_json(point));
  return list;
}

json header_of(const Suite& suite) {
  return {{"pid", 1}, {"identity", to_json(suite)}, {"context", {{"date", "today"}}}};
}

class JournalTest : public ::testing::Test {
 protected:
  std::string out() const { return folder_.file("out.json"); }
  std::string journal() const { return out() + ".journal"; }

  // The whole sweep with a journal, and how many runs it took.
  json run(const Suite& suite, int& runs) {
    Journal journal(out());
    if (journal.header().is_null()) journal.start(header_of(suite));
    FakeMachine machine = hashing_machine();
    const auto outcome =
        run_sweep(suite, plan(suite, {}), {}, journaled(machine.runner(), journal));
    runs = static_cast<int>(machine.specs.size()) + machine.repetitions;
    return points_json(outcome.points);
  }

 private:
  TemporaryFolder folder_{"journal-test"};
};

TEST_F(JournalTest, CutAnywhereTheRestIsRunAndTheResultIsTheSame) {
  const Suite suite = suite_of("strain");
  int all = 0;
  const json whole = run(suite, all);
  const std::string text = read_file(journal(), "journal");
  ASSERT_GT(all, 30);
  const auto seed = std::random_device{}();
  std::cout << "seed " << seed << '\n';
  std::mt19937_64 random(seed);
  for (int i = 0; i < 40; ++i) {
    const std::size_t header = text.find('\n') + 1;
    const std::size_t cut = std::uniform_int_distribution<std::size_t>(header, text.size())(random);
    std::ofstream(journal(), std::ios::trunc) << text.substr(0, cut);
    const auto lines =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(cut), '\n');
    int runs = 0;
    EXPECT_EQ(run(suite, runs), whole) << "cut at " << cut;
    EXPECT_EQ(runs, all - (lines - 1)) << "cut at " << cut;
    EXPECT_EQ(read_file(journal(), "journal"), text) << "cut at " << cut;
  }
}

TEST_F(JournalTest, ACorruptedLineInTheMiddleIsToldByNumberAndTheOthersStand) {
  int runs = 0;
  run(suite_of("strain"), runs);
  const std::size_t points = points_in(Journal(out()));
  std::string text = read_file(journal(), "journal");
  const std::size_t second = text.find('\n') + 1;
  text[text.find("\"status\":\"", second) + 12] ^= 1;  // still JSON
  std::ofstream(journal(), std::ios::trunc) << text;
  Journal journal(out());
  EXPECT_EQ(journal.damage().rfind("line 2: ", 0), 0u) << journal.damage();
  EXPECT_EQ(points_in(journal), points - 1) << "the other lines are as good as before";
  EXPECT_TRUE(journal.header().is_object());
  journal.go_on(journal.header());
  EXPECT_EQ(journal.damage(), "");
}

// A journal without its failures, and one made from the result file.
TEST_F(JournalTest, RemembersAllButFailuresAndAsMuchOfAResultFile) {
  const Suite suite = suite_of("strain");
  int runs = 0;
  const json whole = run(suite, runs);
  const auto failures =
      std::ranges::count_if(whole, [](const json& p) { return p.at("status") != "ok"; });
  ASSERT_GT(failures, 0);
  forget_failures(*std::make_unique<Journal>(out()));
  EXPECT_EQ(run(suite, runs), whole);
  EXPECT_EQ(runs, failures);
  {
    Journal journal(out());
    journal.start(header_of(suite));
    add_runs_of({{"points", whole}}, journal);
  }
  EXPECT_EQ(run(suite, runs), whole);
  EXPECT_EQ(runs, 0);
}

TEST(Pieces, JoinedAreTheWhole) {
  const Suite suite = suite_of("resolution");
  const auto searches = plan(suite, {});
  FakeMachine machine = hashing_machine();
  const auto result = [&](const std::vector<Search>& some, bool complete = true) {
    return result_document({}, suite, {"bench"}, complete,
                           run_sweep(suite, some, {}, machine.runner()).points);
  };
  const auto sorted = [](const json& document) {
    std::vector<std::string> lines;
    for (const json& point : document.at("points")) lines.push_back(point.dump());
    std::ranges::sort(lines);
    return lines;
  };
  const json whole = result(searches);
  EXPECT_TRUE(sorted(joined({whole, whole})) == sorted(whole))
      << "what is listed twice counts once";
  std::map<int, std::vector<Search>> of_size;
  for (const Search& s : searches) of_size[s.base.resolution].push_back(s);
  std::vector<json> pieces;
  for (const auto& [size, some] : of_size) pieces.push_back(result(some));
  EXPECT_EQ(joined(pieces).at("complete"), true);
  EXPECT_TRUE(sorted(joined(pieces)) == sorted(whole));
  pieces.push_back(result(of_size.begin()->second, false));
  EXPECT_EQ(joined(pieces).at("complete"), false) << "a piece was interrupted";
}

}  // namespace
}  // namespace harness
