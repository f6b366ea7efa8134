// kernels: the inner pieces of a step, timed one by one by Google Benchmark, so that the cost of a
// step can be explained from its parts. Names: piece/solver/scene:n. Matrices are those of a cloth
// in mid-drape (above 150 vertices a side soon after its start) and a chain in mid-swing, at the
// positions that a filter gets. Items are constrained edges, or vertices. collision_pass and the
// solves include a copy of their input, a few percent. A pass of strain limiting has its time and
// its bytes a visit of an edge, with the least time that arithmetic (a division) and memory (the
// bytes, at the bandwidth of an array as large as all that a pass reads) leave, and floor_ratio,
// its time over the larger of these two; of_peak and of_bandwidth compare flops of a factorization
// with those of a dense product, and bytes of the factor, read twice by a solve, with the bandwidth
// at which an array of the factor's size is read (the library prints such ratios with "/s" behind
// them).
#include <benchmark/benchmark.h>

#include <bit>
#include <cstdio>

#include "harness/base/clock.h"
#include "harness/base/timing_lock.h"
#include "harness/points/context.h"
#include "harness/scenes/scene.h"
#include "solvers/problem/forces.h"
#include "solvers/registry.h"
#include "solvers/systems/constraint_system.h"

namespace harness::kernels {
namespace {

using namespace inextensible;
using benchmark::Counter;

// ---- What one core of this machine can do at best: the floors that kernels are held against ----

// s of processor time, the shortest of several runs, so that other programs do not count.
template <class Work>
double shortest(int rounds, Work work) {
  double best = HUGE_VAL;
  for (int round = 0; round < rounds; ++round) {
    const double start = thread_seconds();
    work();
    best = std::min(best, thread_seconds() - start);
  }
  return best;
}

// s for a division, independent of others, in single precision and the first-level cache: no pass
// that corrects every edge is faster. Measured at the first call.
double division_seconds() {
  constexpr int passes = 20, edges = 1024;
  static const double all = shortest(1000, [] {
    std::array<float, edges> lengths{};
    lengths.fill(1.2F);
    for (int i = 0; i < passes; ++i) {
      for (float& q : lengths) q = 1.5F - 0.5F / q;
      benchmark::DoNotOptimize(lengths);
    }
  });
  return all / (passes * edges);
}

// In as many sums as hide how long an addition takes.
void read_all(const Eigen::VectorXd& data) {
  constexpr int sums = 32;
  Eigen::Array<double, sums, 1> sum = Eigen::Array<double, sums, 1>::Zero();
  for (Eigen::Index i = 0; i < data.size(); i += sums) sum += data.segment<sums>(i).array();
  benchmark::DoNotOptimize(sum);
}

// Bytes a second at which an array of that size is read over and over: of the cache that it fits
// into, or of memory. Measured at the first call for a size, to a factor of two.
double read_bandwidth(double bytes) {
  static std::map<std::size_t, double> known;
  const auto size =
      std::bit_ceil(std::max<std::size_t>(128, static_cast<std::size_t>(bytes / sizeof(double))));
  double& rate = known[size];
  if (rate > 0) return rate;
  const Eigen::VectorXd data = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(size));
  const std::size_t passes = std::max<std::size_t>(1, (std::size_t{1} << 21) / size);
  const double seconds = shortest(10, [&] {
    for (std::size_t pass = 0; pass < passes; ++pass) read_all(data);
  });
  return rate = static_cast<double>(passes * size * sizeof(double)) / seconds;
}

// Floating-point operations a second in a product of dense matrices, which comes nearest to the
// peak; a fused multiply-add counts as two. Measured at the first call.
double peak_flops() {
  constexpr int size = 256;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Ones(size, size);
  Eigen::MatrixXd c = a;
  static const double seconds = shortest(20, [&] {
    c.noalias() = a * a;
    benchmark::DoNotOptimize(c.data());
  });
  return 2.0 * size * size * size / seconds;
}

// A scene after some steps of fast projection: deformed, and in contact if there is an obstacle.
// Made once: Google Benchmark calls each benchmark several times.
struct Moment {
  Scene scene;
  double h;  // s
  State state;
  Positions x0;  // after the next unconstrained step
  const Problem& problem() const { return *scene.problem; }
};

const Moment& moment(const std::string& scene, int n) {
  static std::map<std::pair<std::string, int>, Moment> moments;
  const auto [place, is_new] = moments.try_emplace({scene, n});
  Moment& m = place->second;
  if (!is_new) return m;
  m.scene = built_scene(scene, {{"n", n}});
  m.h = scene == "drape" ? 0.005 : std::min(0.001, 1.0 / n);
  m.state = m.scene.start;
  const auto stepper = make_stepper("fast_projection", m.scene.problem, {});
  const int wanted = n > (scene == "drape" ? 150 : 200000) ? 4 : 40;
  int steps = 0;
  while (steps < wanted && stepper->advance(m.state, m.h)) ++steps;
  if (steps < wanted)
    std::fprintf(stderr, "kernels: %s:%d: step %d was refused\n", scene.c_str(), n, steps + 1);
  WorkCounters work;
  unconstrained_step(m.problem(), m.state, m.h, m.x0, work);
  return m;
}

Counter rate(double each) { return Counter(each, Counter::kIsIterationInvariantRate); }
Counter average(double all) { return Counter(all, Counter::kAvgIterations); }

void per_item(benchmark::State& state, int items, const char* what = "s_per_edge") {
  state.SetItemsProcessed(state.iterations() * items);
  state.counters[what] = Counter(items, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

// ---- Passes over all edges or vertices ----

void edge_pass(benchmark::State& state, bool gradients, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const EdgeConstraints edges(m.problem(), 1);  // nothing violates: the whole pass
  if (!edges.permissible(m.x0)) return state.SkipWithError("leaves early");
  Eigen::Matrix3Xd u(3, edges.count());
  Eigen::VectorXd c(edges.count());
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(gradients ? edges.linearize(m.x0, u, c) : edges.permissible(m.x0));
    benchmark::ClobberMemory();
  }
  per_item(state, edges.count());
}

void vertex_pass(benchmark::State& state, bool collision, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const Problem& problem = m.problem();
  Positions x = m.x0;
  WorkCounters work;
  std::optional<Contacts> contacts;
  if (collision) contacts.emplace(problem);
  while (state.KeepRunning()) {
    if (collision) {
      x = m.x0;
      contacts->begin(m.state.x, m.state.time, m.h);
      contacts->push_out(x, work);
    } else {
      unconstrained_step(problem, m.state, m.h, x, work);
    }
    benchmark::ClobberMemory();
  }
  per_item(state, problem.vertices(), "s_per_vertex");
  if (collision) state.counters["contacts"] = average(static_cast<double>(work.contacts));
}

std::unique_ptr<VelocityFilter> filter(const Problem& problem, const std::string& method,
                                       double passes) {
  const Backend& row = *find_backend(method);
  BackendOptions options{.settings = complete_settings(row, {})};
  options.settings["max_iterations"] = passes;
  // A pass over yarns alone.
  if (const auto sweeps = options.settings.find("sweeps"); sweeps != options.settings.end())
    sweeps->second = 0.0;
  return row.make_filter(problem, options, Along::edges);
}

// Passes over a cloth stretched by a fifth, so that nearly every edge is corrected. A call that may
// make no pass costs the checks, the refusal and the clock: its time is subtracted.
// own: bytes that are read of an edge; coordinate: of a coordinate of a vertex; transfers: how
// often a visit reads or writes one.
struct Traffic {
  std::string method;
  std::size_t own, coordinate, transfers;
};

void strain_pass(benchmark::State& state, const Traffic& traffic, int n) {
  const Moment& m = moment("drape", n);
  constexpr int passes = 10;
  const auto some = filter(m.problem(), traffic.method, passes),
             none = filter(m.problem(), traffic.method, 0);
  const Positions stretched = 1.2 * m.x0;
  Positions x = stretched;
  WorkCounters work;
  double total = 0;
  while (state.KeepRunning()) {
    x = stretched;
    const double begin = thread_seconds();
    benchmark::DoNotOptimize(none->apply(m.state.x, m.h, x, work));
    const double middle = thread_seconds();
    benchmark::DoNotOptimize(some->apply(m.state.x, m.h, x, work));
    const double seconds = (thread_seconds() - middle) - (middle - begin);
    state.SetIterationTime(seconds);
    total += seconds;
  }
  const int visits = passes * m.problem().constraints();
  per_item(state, visits);
  const auto bytes = static_cast<double>(traffic.own + traffic.transfers * traffic.coordinate),
             all = static_cast<double>(traffic.own * m.problem().constraints() +
                                       3 * traffic.coordinate * m.problem().vertices());
  const double arithmetic = division_seconds(), memory = bytes / read_bandwidth(all);
  state.counters["bytes_per_edge"] = bytes;
  state.counters["least_by_arithmetic"] = arithmetic;
  state.counters["least_by_memory"] = memory;
  state.counters["floor_ratio"] = average(total / visits / std::max(arithmetic, memory));
  state.counters["corrected"] = average(static_cast<double>(work.edge_projections) / visits);
}

// ---- Assembly, factorization and back-substitution: of J W J^T, and of ICD's saddle point ----

// J W J^T at x0 in the solver's order, not yet factored.
struct Linearized {
  Linearized(const Moment& m, std::string_view name)
      : system(m.problem(), 0.01, name),
        u(3, m.problem().constraints()),
        c(m.problem().constraints()),
        solver(make_spd_solver(system.solver_name(), system.schur().pattern())) {
    system.edges().linearize(m.x0, u, c);
    system.schur().assemble(u, solver->values());
  }
  ConstraintSystem system;
  Eigen::Matrix3Xd u;
  Eigen::VectorXd c;
  std::unique_ptr<SpdSolver> solver;
};

void assembly(benchmark::State& state, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const Linearized l(m, "auto");
  while (state.KeepRunning()) {
    l.system.schur().assemble(l.u, l.solver->values());
    benchmark::ClobberMemory();
  }
  per_item(state, m.problem().constraints());
  state.counters["entries"] = l.system.schur().pattern().entries();
}

void linear_solver(benchmark::State& state, const std::string& name, bool solve,
                   const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const Linearized l(m, name);
  if (!l.solver->factor()) return state.SkipWithError("not positive definite");
  Eigen::VectorXd x = l.c;
  while (state.KeepRunning()) {
    if (solve) {
      x = l.c;
      l.solver->solve(x.data());
    } else {
      benchmark::DoNotOptimize(l.solver->factor());
    }
    benchmark::ClobberMemory();
  }
  per_item(state, m.problem().constraints());
  state.counters["nnz_L"] = l.solver->factor_nonzeros();
  if (solve) {
    const double bytes = l.solver->factor_nonzeros() * sizeof(double);
    state.counters["of_bandwidth"] = rate(2 * bytes / read_bandwidth(bytes));
  } else {
    state.counters["flops"] = rate(l.solver->factor_flops());
    state.counters["of_peak"] = rate(l.solver->factor_flops() / peak_flops());
  }
}

template <class Body, class... Arguments>
benchmark::internal::Benchmark* add(const std::string& name, const Body& body,
                                    const Arguments&... arguments) {
  return benchmark::RegisterBenchmark(name.c_str(),
                                      [=](benchmark::State& state) { body(state, arguments...); })
      ->Unit(benchmark::kMicrosecond);
}

void register_steps(const std::string& scene, int n) {
  const std::string at = "/" + scene + ":" + std::to_string(n);
  add("unconstrained_step" + at, vertex_pass, false, scene, n);
  add("edge_pass" + at, edge_pass, true, scene, n);
  add("strain_check" + at, edge_pass, false, scene, n);
  if (scene != "drape") return;
  add("collision_pass" + at, vertex_pass, true, scene, n);
  // Own: vertices, rest length, masses and bounds; the edge at the base; the rows of a yarn.
  for (const Traffic& traffic : std::initializer_list<Traffic>{
           {"gauss_seidel", 2 * sizeof(int) + 4 * sizeof(double), sizeof(double), 12},
           {"gauss_seidel_colored", 4 * sizeof(float), sizeof(float), 12},
           {"jacobi", 4 * sizeof(float), sizeof(float), 24},
           {"yarn_projection", 3 * 7 * sizeof(double), sizeof(double), 12}})
    add("strain_pass/" + traffic.method + at, strain_pass, traffic, n)->UseManualTime();
}

void register_linear_systems(const std::string& scene, int n, const std::vector<std::string>& spd) {
  const std::string at = "/" + scene + ":" + std::to_string(n);
  add("assembly" + at, assembly, scene, n);
  for (const std::string& name : spd) {
    add("factor/" + name + at, linear_solver, name, false, scene, n);
    add("solve/" + name + at, linear_solver, name, true, scene, n);
  }
}

void register_all() {
  const std::vector<std::string> spd{"cholmod_supernodal", "multifrontal", "multifrontal_mixed"};
  for (const int n : {80, 1000, 100000, 1000000}) {
    register_steps("chain", n);
    register_linear_systems("chain", n, {"tridiagonal"});
  }
  for (const int n : {15, 31, 71, 101}) {
    register_steps("drape", n);
    register_linear_systems("drape", n, spd);
  }
}

}  // namespace
}  // namespace harness::kernels

int main(int argc, char** argv) try {
  harness::use_one_thread(argv);
  // An option of all programs that time runs, which Google Benchmark does not know.
  char** const end = std::remove_if(
      argv + 1, argv + argc, [](const char* word) { return std::string(word) == "--no-wait"; });
  const bool wait = end == argv + argc;
  argc = static_cast<int>(end - argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  harness::kernels::register_all();
  const harness::TimingLock lock(wait);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
} catch (const harness::UsageError& error) {
  std::fprintf(stderr, "kernels: %s\n", error.what());
  return 2;
}
