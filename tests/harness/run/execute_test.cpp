// Runs in child processes, whatever a child does to itself; journals and pieces of sweeps.
#include "harness/run/execute.h"

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <fstream>
#include <random>

#include "harness/base/child_process.h"
#include "harness/points/result_file.h"
#include "harness/run/fake_machine.h"
#include "harness/stability/trial.h"

namespace harness {
namespace {

using Work = std::function<void(Heartbeat&)>;

PointSpec chain_of_ten() { return spec_at("chain", {{"n", 10}}, "gauss_seidel", 0.01); }

// A point whose run does `work` when it has come to step 5, t = 0.25 s.
PointResult run_isolated(const Work& work, const RunLimits& limits) {
  const auto run = [&work](const PointSpec& spec, const RunLimits& inner) {
    inner.heartbeat->step = 5;
    inner.heartbeat->time = 0.25;
    work(*inner.heartbeat);
    return PointResult(spec, PointStatus::ok);
  };
  return isolated(run, 0)(chain_of_ten(), limits);
}

void sleep_for_ever() {
  for (;;) pause();
}

TEST(Isolation, ARunInAChildIsTheRunInTheParent) {
  json both[2];
  for (const bool in_child : {false, true}) {
    const Runner run = in_child ? isolated(run_point, 0) : run_point;
    PointResult point = run(chain_of_ten(), {});
    add_sample(point, run, {});
    EXPECT_EQ(point.samples.size(), 2u);
    EXPECT_GT(point.peak_rss_bytes, 1e6);
    both[in_child] = to_json(point);
    for (const char* timing :
         {"seconds_per_simulated_second", "filter_seconds_per_simulated_second", "setup_seconds",
          "phases", "peak_rss_bytes", "frame_times", "cpu_seconds_per_simulated_second",
          "runs_per_sample", "retaken"})
      both[in_child].erase(timing);
  }
  EXPECT_EQ(both[0], both[1]);
}

// Hangs, and its time is up at once: nothing here waits for a clock.
void hang(Heartbeat& heartbeat) {
  heartbeat.begin = heartbeat.begin - 1000;
  sleep_for_ever();
}

TEST(Isolation, WhateverARunDoesIsAStatusThatSaysHowAndWhere) {
  const struct {
    Work work;
    PointStatus status;
    const char *how, *where;
  } rows[] = {
      {[](Heartbeat&) { std::abort(); }, PointStatus::crashed, "SIGABRT", "step 5 (t = 0.25 s)"},
      {[](Heartbeat&) { _exit(9); }, PointStatus::crashed, "exit code 9", ""},
      {[](Heartbeat&) { throw std::runtime_error("bad luck"); }, PointStatus::crashed, "luck", ""},
      {hang, PointStatus::timeout, "SIGTERM", "in step 5"},
      {[](Heartbeat& heartbeat) {
         std::signal(SIGTERM, SIG_IGN);
         hang(heartbeat);
       },
       PointStatus::timeout, "SIGKILL", ""}};
  for (const auto& row : rows) {
    const PointResult point = run_isolated(row.work, {});
    EXPECT_EQ(point.status, row.status) << point.detail;
    EXPECT_NE(point.detail.find(row.how), std::string::npos) << point.detail;
    EXPECT_NE(point.detail.find(row.where), std::string::npos) << point.detail;
    EXPECT_EQ(point.spec.id(), chain_of_ten().id());
  }
}

TEST(Isolation, ATimeOutIsCountedFromTheLastRestart) {
  const PointResult point = run_isolated(
      [](Heartbeat& heartbeat) {
        for (int i = 0; i < 4; ++i) {
          heartbeat.begin = heartbeat.begin - 30;  // of 60 s and a grace: as if that had passed
          usleep(200'000);                         // the parent looks meanwhile
          heartbeat.restart();
        }
      },
      {});
  EXPECT_EQ(point.status, PointStatus::ok) << point.detail;
}

TEST(Isolation, ARunBeyondItsMemoryIsOutOfMemory) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer needs all address space there is";
#endif
  const PointSpec spec = spec_at("drape", {{"n", 301}}, "fast_projection", 0.04);
  std::ifstream statm("/proc/self/statm");
  double pages = 0;
  statm >> pages;
  const double memory = pages * static_cast<double>(sysconf(_SC_PAGESIZE)) + 100e6;
  const PointResult point = isolated(run_point, memory)(spec, {});
  EXPECT_EQ(point.status, PointStatus::out_of_memory) << point.detail;
}

// A child that sleeps; children that finish before they are asked; and children that get the signal
// first, as when a scheduler cancels a job.
TEST(Isolation, AnInterruptEndsTheChildAtOnceAndNoOtherIsMade) {
  RunLimits limits;
  int asked = 0;
  limits.interrupted = [&asked] { return ++asked > 3; };
  EXPECT_THROW(run_isolated([](Heartbeat&) { sleep_for_ever(); }, limits), Interrupted);
  const Work terminate = [](Heartbeat&) {
    ::raise(SIGTERM);
    sleep_for_ever();
  };
  asked = 0;
  EXPECT_THROW(run_isolated(terminate, limits), Interrupted);
  const Work nothing = [](Heartbeat&) {};
  EXPECT_THROW(run_isolated(nothing, limits), Interrupted);
  limits.interrupted = [] { return false; };
  EXPECT_EQ(run_isolated(nothing, limits).status, PointStatus::ok);
  EXPECT_EQ(run_isolated(terminate, limits).status, PointStatus::crashed);
}

TEST(Isolation, ATrialThatCrashesIsAnOutcome) {
  const TrialResult crash =
      run_isolated_trial([]() -> Trial { std::abort(); }, "fast_projection", 1);
  EXPECT_EQ(crash.outcome, Outcome::crashed);
  EXPECT_NE(crash.detail.find("SIGABRT"), std::string::npos);
}

TEST(Isolation, AChildDiesWithItsParent) {
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);  // orphans become this process's children
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    const Work tell_and_sleep = [&](Heartbeat&) {
      const pid_t me = getpid();
      if (write(pipe_ends[1], &me, sizeof me) != sizeof me) _exit(1);
      sleep_for_ever();
    };
    run_isolated(tell_and_sleep, {});
    _exit(0);
  }
  pid_t child = 0;
  ASSERT_EQ(read(pipe_ends[0], &child, sizeof child), static_cast<ssize_t>(sizeof child));
  EXPECT_EQ(kill(child, 0), 0);
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  EXPECT_EQ(waitpid(child, nullptr, 0), child);  // CTest's time-out
}

// ---- Journals and pieces ----

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

json header_of(const Suite& suite) {
  return {{"pid", 1}, {"identity", to_json(suite)}, {"context", {{"date", "today"}}}};
}

struct JournalTest : ::testing::Test {
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
    json list = json::array();
    for (const PointResult& point : outcome.points) list.push_back(to_json(point));
    return list;
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

TEST_F(JournalTest, RemembersAsMuchOfAResultFile) {
  const Suite suite = suite_of("strain");
  int runs = 0;
  const json whole = run(suite, runs);
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
