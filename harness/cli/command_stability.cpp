// bench --sweep stability: the matrix of hard cases.
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/line_journal.h"
#include "harness/base/paths.h"
#include "harness/cli/commands.h"
#include "harness/cli/sweep_command.h"
#include "harness/points/context.h"
#include "harness/points/result_file.h"
#include "harness/run/journal.h"
#include "harness/stability/stability.h"
#include "harness/stability/trial_json.h"

namespace harness {
namespace {

// "ratios=1e3,1e5" into `values`.
void set_values(HardCaseValues& values, const std::string& given) {
  const auto equals = given.find('=');
  const std::string name = given.substr(0, equals);
  const auto place = values.find(name);
  if (place == values.end()) {
    std::vector<std::string> names;
    for (const auto& entry : values) names.push_back(entry.first);
    throw unknown_name("value of hard cases", name, names);
  }
  place->second.clear();
  std::istringstream list(equals == std::string::npos ? "" : given.substr(equals + 1));
  for (std::string item; std::getline(list, item, ',');) {
    std::size_t read = 0;
    try {
      place->second.push_back(std::stod(item, &read));
    } catch (const std::exception&) {
      read = 0;
    }
    if (read == 0 || read != item.size())
      throw UsageError("--values " + given + ": '" + item + "' is not a number");
  }
  if (place->second.empty())
    throw UsageError("--values " + given + ": must be NAME=NUMBER,NUMBER,...");
}

}  // namespace

namespace {

constexpr const char* journal_schema = "inextensible-stability-journal/1";

// The journal of a sweep: a line for each cell that has been run.
class CellJournal {
 public:
  explicit CellJournal(const std::string& out) : lines_(out) {
    lines_.read([this](const nlohmann::json& line, std::size_t number) {
      if (number > 1) {
        cells_[{line.at("case"), line.at("solver")}] = trial_result_of(line.at("result"));
      } else if (line.at("schema") == journal_schema && line.at("identity").is_object()) {
        identity_ = line.at("identity");
      } else {
        throw UsageError("it is not a journal of this program");
      }
    });
  }

  // Throws UsageError unless what it holds may be taken up, or dropped.
  void begin(const SweepCommand& options, const nlohmann::json& mine) {
    const std::string other = identity_.is_null() ? lines_.damage() : difference(identity_, mine);
    const bool any = !cells_.empty() || !lines_.damage().empty();
    if (any && !options.resume && !options.force)
      throw UsageError("'" + lines_.path() + "' holds " + std::to_string(cells_.size()) +
                       " cells of a run that did not finish: --resume goes on with it, --force "
                       "starts anew");
    if (any && options.resume && !options.force && (!other.empty() || !lines_.damage().empty()))
      throw UsageError("'" + lines_.path() + "' is of another build or is damaged: " +
                       (other.empty() ? lines_.damage() : other) +
                       "; --resume --force goes on all the same, --force starts anew");
    if (!options.resume) cells_.clear();
    lines_.start({{"schema", journal_schema}, {"identity", mine}});
    for (const auto& [key, result] : cells_) add(key.first, key.second, result);
  }

  std::optional<TrialResult> find(const std::string& hard_case, const std::string& solver) const {
    const auto place = cells_.find({hard_case, solver});
    return place == cells_.end() ? std::nullopt : std::optional(place->second);
  }
  void add(const std::string& hard_case, const std::string& solver, const TrialResult& result) {
    lines_.append({{"case", hard_case}, {"solver", solver}, {"result", to_json(result)}});
  }
  void remove() { lines_.remove(); }

 private:
  LineJournal lines_;
  nlohmann::json identity_;
  std::map<std::pair<std::string, std::string>, TrialResult> cells_;
};

}  // namespace

int stability_command(const SweepCommand& options, const std::vector<std::string>& command) {
  check_profile(options.profile);
  StabilityFilters filters;
  if (!options.solver.empty()) {
    check_solver_pattern(options.solver);
    filters.solver = Pattern("--solver", options.solver);
  }
  if (!options.hard_case.empty()) filters.hard_case = Pattern("--case", options.hard_case);
  HardCaseValues values = hard_case_values(options.profile);
  for (const std::string& given : options.values) set_values(values, given);
  const auto cases = hard_cases(values);
  const StabilityPlan plan = plan_stability(cases, filters);
  if (options.dry_run) {
    std::cout << plan.cells() << " cells: " << plan.cases.size() << " hard cases by "
              << plan.solvers.size() << " solvers; " << plan.scenes.size()
              << " scenes for each solver's largest step, " << plan.frames.size()
              << " for frames side by side\n";
    return success;
  }
  const std::string out = chosen_output(options, options.profile + "-stability");
  check_writable(out);
  if (!options.force && !options.resume && std::filesystem::exists(out))
    throw UsageError("'" + out +
                     "' is there already: --force replaces it, another --out keeps both");
  if (options.resume && std::filesystem::exists(out) &&
      !std::filesystem::exists(out + ".journal")) {
    std::cout << out << " is complete already\n";
    return success;
  }
  const nlohmann::json context = machine_context();
  CellJournal journal(out);
  journal.begin(options, identity(context, nlohmann::json(values), {{"seed", options.seed}}));
  catch_interrupts();
  StabilityEvents events;
  events.interrupted = interrupted;
  const bool terminal = isatty(STDERR_FILENO) == 1;
  events.known = [&journal](const HardCase& c, const std::string& solver) {
    return journal.find(c.name, solver);
  };
  events.cell = [&](const StabilityCell& cell, std::size_t done, std::size_t all) {
    const std::string& name = cell.hard_case->name;
    if (!journal.find(name, cell.solver)) journal.add(name, cell.solver, cell.result);
    if (terminal) {
      std::cerr << "\r\033[K[" << done << '/' << all << "] " << cell.hard_case->name << '/'
                << cell.solver << (done == all ? "\n" : "");
    } else if (done % 100 == 0 || done == all) {
      std::cerr << '[' << done << '/' << all << "]\n";
    }
  };
  events.largest_step = [](const LargestStep& found) {
    std::cerr << "largest step, " << found.scene << '/' << found.solver << '\n';
  };
  events.same_frame = [](const SameFrame& found) {
    std::cerr << "the same frame, " << found.scene.name() << '\n';
  };
  const std::uint64_t seed = options.seed < 0 ? 1 : static_cast<std::uint64_t>(options.seed);
  const StabilityOutcome outcome = run_stability(plan, seed, events);
  write_atomically(out, result_text(stability_document(context, outcome, seed, command)));
  print_stability(std::cout, outcome);
  std::cout << "\nwritten:\n" << out << std::endl;
  if (!outcome.complete) {
    std::cerr << "bench: interrupted; the same command with --resume goes on from here\n";
    return interrupted_exit;
  }
  journal.remove();
  if (!options.no_plots && draw({out}) != 0) std::cerr << "bench: the figure could not be drawn\n";
  return outcome.nothing_new() ? success : unexpected_outcome;
}

}  // namespace harness
