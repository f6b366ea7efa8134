#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <csignal>
#include <deque>

#include "harness/base/clock.h"
#include "harness/base/files.h"
#include "harness/base/json.h"
#include "harness/base/text.h"
#include "harness/points/plugins.h"
#include "harness/scenes/scene_folder.h"
#include "solvers/c_method.h"

namespace harness {
namespace {

using inextensible::Positions, inextensible::State, inextensible::Status, inextensible::StepResult;

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

class ProcessStepper final : public inextensible::ForeignStepper {
 public:
  ProcessStepper(const std::string& command, std::shared_ptr<const inextensible::Problem> shared,
                 const inextensible::BackendOptions& options)
      : ForeignStepper(std::move(shared)), folder_("scene"), process_(command) {
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
  StepResult take(const State& /*state*/, InextensibleStep& step) override {
    const auto begin = Clock::now();
    const std::size_t bytes = 3 * sizeof(double) * problem().vertices();
    const double times[] = {step.h, step.time};
    double outcome[] = {0, 0};
    try {
      process_.write(times, sizeof times);
      process_.write(step.x, bytes);
      process_.write(step.v, bytes);
      if (step.pose) process_.write(step.pose, 12 * sizeof(double));
      process_.read(outcome, sizeof outcome);
      process_.read(step.x, bytes);
      process_.read(step.v, bytes);
    } catch (const std::runtime_error&) {
      return {Status::not_converged, 0, -1, 0, "the program has ended"};
    }
    step.copy_seconds = std::max(0.0, since(begin) - outcome[1]);
    if (outcome[0] != 0) return {Status::not_converged, 0, -1, 0, "the program refused the step"};
    const auto finite = [n = problem().vertices()](const double* numbers) {
      return Eigen::Map<const Positions>(numbers, 3, n).allFinite();
    };
    if (!finite(step.x) || !finite(step.v)) return {Status::not_finite, 0, -1, 0, "overflow"};
    return {};
  }

  TemporaryFolder folder_;
  Process process_;
};

const char* kept(std::string text) {
  static std::deque<std::string> texts;  // rows of the registry refer to them
  return texts.emplace_back(std::move(text)).c_str();
}

}  // namespace

ProcessSolver process_solver(const std::string& command) {
  const json about = Process(command).hear();
  if (about.value("inextensible", 0) != 1)
    throw std::runtime_error(
        "its first line must be a JSON object with \"inextensible\": 1, the version of the "
        "protocol (docs/plugins.md)");
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
  const auto takes = about.value("takes", std::vector<std::string>());
  const json settings = about.value("settings", json::object());
  for (const std::string& part : takes) {
    if (!parts.contains(part))
      throw std::runtime_error("it takes '" + shortened(part) + "', which is unknown");
    *parts.at(part) = true;
  }
  if (about.value("whole_step", false)) row.velocities = inextensible::Velocities::whole_step;
  if (about.value("keeps_limit", false))
    row.strain_control = inextensible::StrainControl::strain_limit;
  for (const auto& [name, value] : settings.items()) {  // initial, least, largest, meaning, search
    const auto number = [&list = value](std::size_t i) {
      return list.size() > i ? list.at(i).get<double>() : 0;
    };
    const bool whole = value.at(0).is_number_integer() && value.at(1).is_number_integer();
    row.settings.push_back(
        inextensible::setting_of(row.name, {kept(name), kept(value.at(3)), number(0), number(1),
                                            number(2), number(4), number(5), whole, nullptr}));
  }

  row.make = [command](std::shared_ptr<const inextensible::Problem> problem,
                       const inextensible::BackendOptions& options) {
    return std::make_unique<ProcessStepper>(command, std::move(problem), options);
  };
  return {std::move(row), about.value("version", "")};
}

}  // namespace harness
