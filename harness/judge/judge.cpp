#include "harness/judge/judge.h"

#include <Eigen/Geometry>
#include <numeric>

#include "harness/base/statistics.h"
#include "solvers/problem/forces.h"

namespace harness {

using Eigen::Vector3d, inextensible::TriangleMesh;

namespace {

constexpr double time_tolerance = 1e-9;  // s; states add up their steps

double root_mean_square(const std::vector<double>& numbers) {
  const double squares = std::inner_product(numbers.begin(), numbers.end(), numbers.begin(), 0.0);
  return std::sqrt(squares / static_cast<double>(numbers.size()));
}

// ---- Ways through the body ----

constexpr double never = std::numeric_limits<double>::infinity();

Vector3d normal_of(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return (b - a).cross(c - a).normalized();
}

// Where the line from + t way goes through a triangle (Moeller and Trumbore 1997); `never`: not.
double meets(const TriangleMesh& mesh, const std::array<int, 3>& triangle, const Vector3d& from,
             const Vector3d& way) {
  const Vector3d& a = mesh.vertices[triangle[0]];
  const Vector3d e1 = mesh.vertices[triangle[1]] - a, e2 = mesh.vertices[triangle[2]] - a;
  const Vector3d p = way.cross(e2), s = from - a, q = s.cross(e1);
  const double det = e1.dot(p);
  if (det == 0) return never;
  const double u = s.dot(p) / det, v = way.dot(q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 ? e2.dot(q) / det : never;
}

// The shortest way from the middle of a face straight through the body; at most 250 faces are
// tried, and ten million pairs of faces.
double thickness_of(const TriangleMesh& mesh) {
  double least = never;
  const std::size_t faces = mesh.triangles.size(),
                    stride = 1 + faces / std::clamp<std::size_t>(10'000'000 / (faces + 1), 10, 250);
  for (std::size_t i = 0; i < faces; i += stride) {
    const auto& face = mesh.triangles[i];
    const Vector3d inwards = -normal_of(mesh, face);
    const Vector3d middle =
        (mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]) / 3;
    for (std::size_t k = 0; k < faces; ++k) {
      const double way = k == i ? never : meets(mesh, mesh.triangles[k], middle, inwards);
      if (way > 0) least = std::min(least, way);
    }
  }
  return least;
}

}  // namespace

Judge::Judge(const Scene& scene, const Options& options)
    : scene_(scene),
      options_(options),
      energy_(scene, options.velocities),
      crossings_(*scene.problem) {
  options_.sample_every = std::max(1, options_.sample_every);
  if (options_.residuals) probe_.emplace();
}

void Judge::before(const State& state, double h) {
  if (probe_ && (steps_ + 1) % options_.sample_every == 0) probe_->watch();
  crossings_.before(state);
  // A sample in the middle of a step is interpolated.
  if (options_.reference && next_ < options_.reference->times.size() &&
      options_.reference->times[next_] < state.time + h - time_tolerance)
    start_ = state;
}

// Distances to the reference at the samples that the last step has reached.
void Judge::compare(const State& state) {
  const Reference& reference = *options_.reference;
  for (; next_ < reference.times.size() && reference.times[next_] <= state.time + time_tolerance;
       ++next_) {
    const double time = reference.times[next_];
    const bool inside = time < state.time - time_tolerance;
    const double part = inside ? (time - start_.time) / (state.time - start_.time) : 1;
    const Positions x = inside ? Positions((1 - part) * start_.x + part * state.x) : state.x;
    if (next_ >= reference.positions.size()) continue;
    const Positions& there = reference.positions[next_];
    running_.error_series.push_back({time, rms_distance(scene_, x, there),
                                     max_distance(scene_, x, there), reference.gap[next_],
                                     reference.gap_max[next_]});
    moved_squares_ += std::pow(rms_distance(scene_, x, scene_.start.x), 2);
    reference_moved_squares_ += std::pow(rms_distance(scene_, there, scene_.start.x), 2);
  }
}

// A run that ended before the last sure sample has no error: it would be one of fewer samples.
void Judge::add_errors(Measures& measures) const {
  const ErrorAtLevel at = error_at(measures, headline_error);
  measures.error_samples = static_cast<int>(at.samples);
  if (at.samples > 0) measures.error_until = at.until;
  const int wanted = options_.reference->samples_at(headline_error);
  const std::string level = number_text(100 * headline_error) + " %";
  if (wanted == 0) {
    measures.unknown_because =
        "the reference is not known to within " + level + " at any sample time";
  } else if (at.samples < wanted) {
    measures.unknown_because = concat("the run ended after ", at.samples, " of ", wanted,
                                      " samples at which the reference is known to within ", level);
  } else {
    measures.trajectory = at.distance;
    measures.trajectory_mean = at.mean;
    measures.trajectory_max = at.largest;
    measures.gap = at.gap;
  }
}

double Judge::after(const Positions& filtered, const State& state, double h, bool counts) {
  const StrainRange range = strain_range(*scene_.problem, filtered);
  running_.max_strain = std::max(running_.max_strain, range.most);
  if (scene_.problem->collider())
    raise(running_.max_strain_after_collision, strain_range(*scene_.problem, state.x).most);
  energy_.after(state, h);
  crossings_.after(state);
  look_at_marks(state, h);
  if (counts && ++steps_ % options_.sample_every == 0) {
    sample(filtered, state);
    if (const auto residual = probe_ ? probe_->residual(state.time) : std::nullopt)
      running_.residuals.push_back(*residual);
  }
  if (options_.reference) compare(state);
  return range.most;
}

void Judge::look_at_marks(const State& state, double h) {
  if (scene_.marks.empty() || state.time < scene_.duration * 2 / 3 + time_tolerance) return;
  if (!state.x.allFinite() || !state.v.allFinite()) return;
  for (const Scene::Mark& mark : scene_.marks)
    running_.sag[mark.name] += h * (mark.height - state.x(1, mark.vertex));
  const Problem& problem = *scene_.problem;
  squared_speed_ += h * 2 * inextensible::kinetic_energy(problem, state.v) / problem.total_mass();
  marked_time_ += h;
}

void Judge::sample(const Positions& filtered, const State& state) {
  const auto& problem = *scene_.problem;
  append_strains(problem, filtered, strains_);
  kinetic_sum_ += inextensible::kinetic_energy(problem, state.v);
  ++samples_;
}

Measures Judge::finish() {
  energy_.finish();
  Measures measures = running_;
  measures.energy_gain = energy_.gain();
  if (scene_.conserves_energy) measures.energy_drift = energy_.drift();
  if (energy_can_only_fall(*scene_.problem)) measures.energy_rise = energy_.rise();
  if (samples_ > 0) {
    measures.kinetic_energy_mean = kinetic_sum_ / samples_;
    measures.rms_strain = root_mean_square(strains_);
    measures.p99_strain = quantile(strains_, 0.99);
  }
  if (marked_time_ > 0) {
    for (auto& [name, sag] : measures.sag) sag /= marked_time_;
    measures.rest_speed = std::sqrt(squared_speed_ / marked_time_);
  }
  if (!options_.reference) {
    measures.unknown_because = "no reference of this scene, size and parameters";
    return measures;
  }
  measures.reference = options_.reference->name();
  measures.valid_until = options_.reference->valid_until;
  add_errors(measures);
  // To six digits: a series is for pictures and sums, and files should stay small.
  for (ErrorSample& at : measures.error_series)
    for (double* value : {&at.time, &at.error, &at.worst, &at.gap, &at.worst_gap})
      *value = rounded_to(*value);
  if (reference_moved_squares_ > 0)
    measures.moved = std::sqrt(moved_squares_ / reference_moved_squares_);
  return measures;
}

void ResidualProbe::iterate(const inextensible::EdgeConstraints& edges, int j, const Positions& x,
                            const Eigen::VectorXd& multipliers) {
  if (!watching_) return;
  edges_ = &edges;
  iterations_ = j;
  if (j == 0) {
    x0_ = x;
    return;
  }
  // Kept only: the solver's clock runs.
  Iterate& kept = j == 1 ? first_ : last_;
  kept.x = x;
  kept.multipliers = multipliers;
}

double ResidualProbe::mean_residual(const Iterate& at) const {
  Eigen::Matrix3Xd u(3, at.multipliers.size());
  edges_->gradient(at.x, u);
  Positions f = at.x - x0_;
  edges_->apply(u, -at.multipliers, f);
  return f.colwise().norm().mean();
}

std::optional<ResidualSample> ResidualProbe::residual(double time) {
  watching_ = false;
  if (iterations_ == 0) return {};
  const double first = mean_residual(first_);
  return ResidualSample{time, first, iterations_ == 1 ? first : mean_residual(last_)};
}

Crossings::Crossings(const Problem& problem) : problem_(problem) {
  const auto* body = dynamic_cast<const inextensible::TriangleCollider*>(problem.collider());
  if (!body) return;
  body_ = &body->mesh();
  thickness_ = thickness_of(*body_);
  crossed_.assign(static_cast<std::size_t>(problem.vertices()), 0);
}

int Crossings::vertices() const { return static_cast<int>(std::ranges::count(crossed_, char{1})); }

Positions Crossings::in_body_frame(const State& state) const {
  Positions x = state.x;
  if (const BodyMotion& motion = problem_.body_motion()) {
    const Pose back = motion(state.time).inverse();
    for (auto column : x.colwise()) column = back(column);
  }
  return x;
}

void Crossings::before(const State& state) {
  if (body_) from_ = in_body_frame(state);
}

void Crossings::after(const State& state) {
  if (!body_) return;
  const Positions to = in_body_frame(state);
  constexpr double nearly = 0.8;
  for (Eigen::Index v = 0; v < to.cols(); ++v) {
    if (!((to.col(v) - from_.col(v)).norm() >= nearly * thickness_)) continue;
    if (passes_through(from_.col(v), to.col(v))) crossed_[v] = 1;
  }
}

// The way is lengthened a little at both ends, for vertices that lie on the surface.
bool Crossings::passes_through(const Vector3d& from, const Vector3d& to) const {
  constexpr double opposite = -0.5;  // cosine
  const double more = 0.1 * thickness_ / (to - from).norm();
  std::vector<Vector3d> normals;
  for (const auto& triangle : body_->triangles) {
    const double at = meets(*body_, triangle, from, to - from);
    if (at >= -more && at <= 1 + more) normals.push_back(normal_of(*body_, triangle));
  }
  for (const Vector3d& a : normals)
    for (const Vector3d& b : normals)
      if (a.dot(b) < opposite) return true;
  return false;
}

}  // namespace harness
