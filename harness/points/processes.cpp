#include "harness/points/processes.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <deque>

#include "harness/base/clock.h"
#include "harness/base/files.h"
#include "harness/base/json.h"
#include "harness/base/text.h"
#include "harness/scenes/scene_folder.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::State;
using inextensible::Status;
using inextensible::StepResult;

// A program whose standard input and output are ours. Its errors go where ours go, and it ends with
// this process at the latest.
class Process {
 public:
  explicit Process(const std::string& command) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      throw FileError("a program", "start");
    channel_ = OpenFile(ends[0]);
    const OpenFile theirs(ends[1]);
    pid_ = fork();
    if (pid_ < 0) throw FileError("a program", "start");
    if (pid_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      dup2(theirs.get(), STDIN_FILENO);
      dup2(theirs.get(), STDOUT_FILENO);
      execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
      _exit(127);
    }
    clockid_t clock{};
    if (clock_getcpuclockid(pid_, &clock) == 0) helper_clock = clock;
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    helper_clock.reset();
    channel_ = OpenFile();  // the sign to end
    for (int waited = 0; waitpid(pid_, nullptr, WNOHANG) == 0; ++waited) {
      if (waited == 100) kill(pid_, SIGKILL);
      usleep(10'000);
    }
  }

  // Both throw std::runtime_error if the program has ended.
  void write(const void* data, std::size_t size) {
    for (const auto* from = static_cast<const char*>(data); size > 0;)
      from += moved(send(channel_.get(), from, size, MSG_NOSIGNAL), size);
  }
  void read(void* data, std::size_t size) {
    for (auto* to = static_cast<char*>(data); size > 0;)
      to += moved(recv(channel_.get(), to, size, 0), size);
  }

  void say(const json& object) {
    const std::string line = object.dump() + "\n";
    write(line.data(), line.size());
  }
  json hear() {
    constexpr std::size_t longest = 1 << 16;
    std::string line;
    for (char c = 0; c != '\n';) {
      read(&c, 1);
      line += c;
      if (line.size() > longest) throw std::runtime_error("it does not speak the protocol");
    }
    return parse_document(line, "its line");
  }

 private:
  static std::size_t moved(ssize_t bytes, std::size_t& left) {
    if (bytes < 0 && errno == EINTR) return 0;
    if (bytes <= 0) throw std::runtime_error("the program has ended");
    left -= static_cast<std::size_t>(bytes);
    return static_cast<std::size_t>(bytes);
  }

  pid_t pid_ = -1;
  OpenFile channel_;
};

class ProcessStepper final : public inextensible::Stepper {
 public:
  ProcessStepper(const std::string& command, std::shared_ptr<const inextensible::Problem> shared,
                 const inextensible::BackendOptions& options)
      : Stepper(std::move(shared)), folder_("scene"), process_(command) {
    Scene scene;
    scene.problem = problem_;
    scene.start.x = Positions::Zero(3, problem().vertices());
    scene.start.v = scene.start.x;
    if (options.start) scene.start = *options.start;
    write_scene(folder_.path(), scene);
    process_.hear();  // what it is
    json settings = json::object();
    for (const auto& [name, value] : options.settings) settings[name] = std::get<double>(value);
    process_.say({{"scene", folder_.path()},
                  {"strain_limit", options.strain_limit},
                  {"seed", options.seed},
                  {"settings", settings}});
    const json answer = process_.hear();
    if (answer.contains("refused"))
      throw std::invalid_argument(shortened(answer.at("refused").get<std::string>()));
  }

 private:
  // To the program: h, the time, x, v, and the pose of a body that moves. From it: 0 or not 0 where
  // it refuses the step, the seconds that it took by its own clock, x, v.
  StepResult solve(const State& state, double h, Positions& x) override {
    const auto begin = Clock::now();
    const int n = problem().vertices();
    to_.resize(2 + 6 * n + (problem().body_motion() ? 12 : 0));
    from_.resize(2 + 6 * n);
    to_.head(2) << h, state.time;
    to_.segment(2, 3 * n) = state.x.reshaped();
    to_.segment(2 + 3 * n, 3 * n) = state.v.reshaped();
    if (const auto& motion = problem().body_motion()) {
      const inextensible::Pose pose = motion(state.time + h);
      Eigen::Matrix<double, 4, 3> rows;  // transposed
      rows << pose.turn.transpose(), pose.translation.transpose();
      to_.tail(12) = rows.reshaped();
    }
    try {
      process_.write(to_.data(), to_.size() * sizeof(double));
      process_.read(from_.data(), from_.size() * sizeof(double));
    } catch (const std::runtime_error&) {
      return {Status::not_converged, 0, -1, 0, "the program has ended"};
    }
    x = from_.segment(2, 3 * n).reshaped(3, n);
    v_ = from_.segment(2 + 3 * n, 3 * n).reshaped(3, n);
    for (const int pin : problem().pinned()) x.col(pin) = state.x.col(pin);
    x_ = x;
    if (phases_wanted_) {
      phases_.filter += from_[1];
      phases_.copy += std::max(0.0, since(begin) - from_[1]);
    }
    if (from_[0] != 0) return {Status::not_converged, 0, -1, 0, "the program refused the step"};
    if (!from_.allFinite()) return {Status::not_finite, 0, -1, 0, "overflow"};
    return {};
  }

  // What the collision filter has moved, it has moved in a step.
  StepResult end_velocities(const State& start, double h, const Positions& x,
                            Positions& v) override {
    v = v_ + (x - x_) * (1 / h);
    for (const int pin : problem().pinned()) v.col(pin) = (x.col(pin) - start.x.col(pin)) / h;
    return {};
  }

  TemporaryFolder folder_;
  Process process_;
  Eigen::VectorXd to_, from_;
  Positions v_, x_;
};

const char* kept(std::string text) {
  static std::deque<std::string> texts;  // rows of the registry refer to them
  return texts.emplace_back(std::move(text)).c_str();
}

inextensible::SettingInfo setting_of(const std::string& name, const json& numbers) {
  inextensible::SettingInfo info{
      .name = kept(name), .initial = numbers.at(0).get<double>(), .meaning = kept(numbers.at(3))};
  info.range = {.least = numbers.at(1), .largest = numbers.at(2)};
  info.range.whole = numbers.at(0).is_number_integer() && numbers.at(1).is_number_integer();
  if (numbers.size() > 5) info.tunable = {{numbers.at(4), numbers.at(5)}};
  return info;
}

}  // namespace

ProcessSolver process_solver(const std::string& command) {
  const json about = Process(command).hear();
  if (about.value("inextensible", 0) != 1)
    throw std::runtime_error(
        "its first line must be a JSON object with \"inextensible\": 1, the "
        "version of the protocol (docs/plugins.md)");
  const auto text = [&](const char* key) { return kept(about.value(key, "")); };
  inextensible::Backend row{.name = text("name"), .summary = text("summary")};
  row.label = text("label");
  row.citation = text("citation");
  row.strain_control = inextensible::StrainControl::time_step;
  row.conserves_momentum = row.takes_shear = row.takes_bending = row.takes_drag =
      row.takes_implicit_forces = row.takes_collider = false;
  std::map<std::string, bool*> parts{{"collider", &row.takes_collider},
                                     {"shear", &row.takes_shear},
                                     {"bending", &row.takes_bending},
                                     {"drag", &row.takes_drag},
                                     {"stiff_forces", &row.takes_implicit_forces},
                                     {"momentum", &row.conserves_momentum}};
  const json takes = about.value("takes", json::array());
  const json settings = about.value("settings", json::object());
  for (const std::string part : takes) {
    if (!parts.contains(part))
      throw std::runtime_error("it takes '" + shortened(part) + "', which is unknown");
    *parts.at(part) = true;
  }
  if (about.value("whole_step", false)) row.velocities = inextensible::Velocities::whole_step;
  if (about.value("keeps_limit", false))
    row.strain_control = inextensible::StrainControl::strain_limit;
  for (const auto& [name, numbers] : settings.items())
    row.settings.push_back(setting_of(name, numbers));
  row.make = [command](std::shared_ptr<const inextensible::Problem> problem,
                       const inextensible::BackendOptions& options) {
    return std::make_unique<ProcessStepper>(command, std::move(problem), options);
  };
  return {std::move(row), about.value("version", "")};
}

}  // namespace harness
