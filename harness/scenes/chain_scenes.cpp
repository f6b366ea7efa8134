// Scenes of chains. Some begin straight or folded: released, taut between pins, and folded into a
// U, one arm of which moves along the other: faster and faster, because what moves becomes less and
// its energy stays. Others hang, and their motion or rest is known: small oscillations, the
// catenary, and a chain that whirls about the vertical.
#include <gsl/gsl_integration.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "harness/scenes/meshes.h"

namespace harness {
namespace {

// ---- Straight and folded ----

// n vertices on a straight horizontal line, vertex 0 pinned, at rest, released.
Scene build_chain(const SceneParameters& p) {
  Draft chain = vertex_row(p);
  const int n = whole(p);
  for (int i = 0; i < n; ++i) chain.scene.start.x(0, i) = p.at("length") * i / (n - 1);
  return released(std::move(chain), {0});
}

// n vertices on a straight horizontal line, both ends pinned `stretch` times its length apart.
Scene build_taut_row(const SceneParameters& p) {
  Draft row = vertex_row(p);
  const int n = whole(p);
  const double span = p.at("length") * p.at("stretch");
  for (int i = 0; i < n; ++i) row.scene.start.x(0, i) = 0.5 * span * (2 * i - (n - 1)) / (n - 1);
  return released(std::move(row), {0, n - 1});
}

// Vertex 0, the pin, is at the top; the still arm hangs from it, and one link across (two, if the
// number of links is even) leads to the other arm, which ends at the top.
Scene build_folded(const SceneParameters& p) {
  Draft chain = vertex_row(p);
  const int n = whole(p), links = n - 1;
  const double link = row_link(p), speed = value_or_zero(p, "speed");
  const int arm = (links - 1) / 2, across = links - 2 * arm;
  State& start = chain.scene.start;
  for (int i = 1; i < n; ++i) {
    const Eigen::Vector3d along = i <= arm            ? Eigen::Vector3d(0, -link, 0)
                                  : i <= arm + across ? Eigen::Vector3d(link, 0, 0)
                                                      : Eigen::Vector3d(0, link, 0);
    start.x.col(i) = start.x.col(i - 1) + along;
    if (i >= arm + across) start.v(1, i) = -speed;
  }
  return released(std::move(chain), {0});
}

SceneParameterInfo vertices(int n, double least) {
  return {"n", static_cast<double>(n), "vertices", least, 10'000'000, true};
}

// ---- Hanging ----

// The Laguerre polynomials' recurrence x L_i = -(i + 1) L_{i+1} + (2 i + 1) L_i - i L_{i-1} as a
// matrix: its eigenvalues are the zeros of L_N, ascending, and component i of an eigenvector is
// L_i(x_k) up to a factor (Golub and Welsch 1969).
Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> laguerre(int masses, int options) {
  Eigen::VectorXd diagonal(masses), off(masses - 1);
  for (int i = 0; i < masses; ++i) diagonal(i) = 2 * i + 1;
  for (int i = 0; i + 1 < masses; ++i) off(i) = -(i + 1);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off, options);
  return solver;
}

// Vertex 0 is the pin. Deflections in x are the free end's times L_i(x_k) cos(omega t), i counted
// from the free end; heights follow from the links.
Positions swung(const SceneParameters& p, double time) {
  const int masses = whole(p) - 1, mode = whole(p, "mode");
  if (mode > masses)
    throw std::invalid_argument("mode " + std::to_string(mode) + " of a chain of " +
                                std::to_string(masses) + " links");
  const double link = row_link(p);
  const auto laguerres = laguerre(masses, Eigen::ComputeEigenvectors);
  const double omega = std::sqrt(p.at("gravity") / link * laguerres.eigenvalues()(mode - 1));
  const Eigen::VectorXd shape = laguerres.eigenvectors().col(mode - 1);
  const double aside = p.at("amplitude") * p.at("length") * std::cos(omega * time) / shape(0);
  Positions x = Positions::Zero(3, masses + 1);
  for (int i = 1; i <= masses; ++i) {
    x(0, i) = aside * shape(masses - i);
    const double across = x(0, i) - x(0, i - 1);
    if (!(std::abs(across) < link))
      throw std::invalid_argument("an amplitude of " + std::to_string(p.at("amplitude")) +
                                  " lengths is not small: link " + std::to_string(i - 1) +
                                  " would be horizontal");
    x(1, i) = x(1, i - 1) - std::sqrt(link * link - across * across);
  }
  return x;
}

Scene build_hanging_chain(const SceneParameters& p) {
  Draft chain = vertex_row(p);
  chain.scene.start.x = swung(p, 0);
  return released(std::move(chain), {0});
}

// Link i of N, from the left, leads in the direction (H, V_i), V_i = m g (i - (N + 1) / 2): what
// bears the horizontal tension H at both ends and the weight between. H is where the links reach
// from pin to pin.
Positions catenary(const SceneParameters& p) {
  const int n = whole(p), links = n - 1;
  const double link = row_link(p), span = p.at("length") / p.at("slack");
  const double weight = p.at("mass") / n * p.at("gravity");
  const auto direction = [&](int i, double tension) {
    return Eigen::Vector3d(tension, weight * (i - 0.5 * (links + 1)), 0).normalized();
  };
  double low = 1e-9 * weight, high = 1e9 * weight * links;
  for (int k = 0; k < 200; ++k) {
    const double tension = std::sqrt(low * high);
    double reach = 0;
    for (int i = 1; i <= links; ++i) reach += link * direction(i, tension).x();
    (reach < span ? low : high) = tension;
  }
  Positions x = Positions::Zero(3, n);
  for (int i = 1; i < n; ++i) x.col(i) = x.col(i - 1) + link * direction(i, low);
  return x;
}

Scene build_catenary(const SceneParameters& p) {
  Draft chain = vertex_row(p);
  chain.scene.start.x = catenary(p);
  return released(std::move(chain), {0, whole(p) - 1});
}

double whirling_rate(const SceneParameters& p) {  // rad/s
  return p.at("rate") * hanging_frequency(whole(p) - 1, row_link(p), p.at("gravity"), 1);
}

// Distances from the axis and depths below the pin, from the free end at the distance `radius`
// upwards: each link leads along the force that keeps all below it on their circles.
Eigen::Matrix2Xd whirled(const SceneParameters& p, double radius) {
  const int n = whole(p);
  const double link = row_link(p), omega = whirling_rate(p);
  Eigen::Matrix2Xd at(2, n);
  at.col(n - 1) << radius, 0;
  Eigen::Vector2d force(0, 0);  // over one vertex's mass: inwards, upwards
  for (int i = n - 1; i > 0; --i) {
    force += Eigen::Vector2d(-omega * omega * at(0, i), p.at("gravity"));
    at.col(i - 1) = at.col(i) + link * force.normalized();
  }
  at.row(1).array() -= at(1, 0);
  return at;
}

// At first in the plane x-y, with the pin on the axis.
Positions whirling(const SceneParameters& p, double time) {
  double low = 1e-6 * p.at("length"), high = p.at("length");
  for (int k = 0; k < 200; ++k) {
    const double radius = 0.5 * (low + high);
    (whirled(p, radius)(0, 0) < 0 ? low : high) = radius;
  }
  const Eigen::Matrix2Xd shape = whirled(p, 0.5 * (low + high));
  Positions x = Positions::Zero(3, shape.cols());
  x.topRows(2) = shape;
  x.col(0).setZero();
  return Eigen::AngleAxisd(whirling_rate(p) * time, Eigen::Vector3d::UnitY()).toRotationMatrix() *
         x;
}

Scene build_whirling_chain(const SceneParameters& p) {
  Draft chain = vertex_row(p);
  State& start = chain.scene.start;
  start.x = whirling(p, 0);
  start.v.row(2) = -whirling_rate(p) * start.x.row(0);
  return released(std::move(chain), {0});
}

// Sizes to which eigenvectors are quick to find.
SceneType hanging(const char* name, const char* summary, const ParameterInfos& own,
                  Scene (*build)(const SceneParameters&),
                  Positions (*exact)(const SceneParameters&, double)) {
  return {.name = name,
          .summary = summary,
          .parameters = row_parameters({"n", 21, "vertices", 3, 2000, true},
                                       joined({{gravity_info(0)}, own})),
          .build = build,
          .counts = count_row,
          .exact = exact,
          .like = "chain"};
}

}  // namespace

// t = integral of L ds / v; with s = u^2 the integrand is smooth.
double folded_fall_time(double part, double length, double gravity) {
  const std::unique_ptr<gsl_integration_glfixed_table,
                        decltype(&gsl_integration_glfixed_table_free)>
      nodes(gsl_integration_glfixed_table_alloc(32), gsl_integration_glfixed_table_free);
  gsl_function rate{[](double u, void*) { return 2 * std::sqrt((1 - u * u) / (2 - u * u)); },
                    nullptr};
  return std::sqrt(length / gravity) *
         gsl_integration_glfixed(&rate, 0, std::sqrt(part), nodes.get());
}

std::vector<SceneType> line_scenes() {
  return {
      {.name = "chain",
       .summary = "a straight horizontal chain, pinned at one end, released",
       .parameters = row_parameters(vertices(80, 2), {gravity_info()}),
       .build = build_chain,
       .counts = count_row,
       .pendulum = true},
      {.name = "taut_row",
       .summary = "a straight chain between two pins at its full length: J W J^T is singular",
       .parameters = row_parameters(
           vertices(31, 3),
           {gravity_info(),
            {"stretch", 1, "distance of the pins over the length; above 1: infeasible", 0, 100}}),
       .build = build_taut_row,
       .counts = count_row},
      {.name = "folded_chain",
       .summary = "a chain folded into a U, pinned at one end: the other falls faster than free",
       .parameters = row_parameters(vertices(80, 4), {gravity_info(0)}, 0.4),
       .build = build_folded,
       .counts = count_row,
       .like = "chain"},
      {.name = "whip",
       .summary = "a chain folded into a U without weight, one arm pinned, the other moving: its "
                  "end cracks",
       .parameters = row_parameters(
           vertices(80, 4), {{"speed", 1, "of the moving arm at the start, m/s", 0, 1e4}}, 0.7),
       .build = build_folded,
       .counts = count_row,
       .like = "chain"}};
}

double hanging_frequency(int masses, double link, double gravity, int mode) {
  return std::sqrt(gravity / link *
                   laguerre(masses, Eigen::EigenvaluesOnly).eigenvalues()(mode - 1));
}

std::vector<SceneType> hanging_scenes() {
  return {hanging("hanging_chain",
                  "a chain that hangs and swings a little in one of its modes: its motion is known",
                  {{"mode", 1, "of its oscillations", 1, 1999, true},
                   {"amplitude", 1e-3, "of the free end, over the length", 0, 0.1}},
                  build_hanging_chain, swung),
          hanging("catenary", "a chain that hangs at rest between two pins: it stays",
                  {{"slack", 1.2, "length over the distance of the pins", 1, 100}}, build_catenary,
                  [](const SceneParameters& p, double) { return catenary(p); }),
          hanging("whirling_chain",
                  "a chain that whirls about the vertical as a rigid curve: its motion is known",
                  {{"rate", 1.5, "of turning, over the slowest oscillation's", 1, 2.2}},
                  build_whirling_chain, whirling)};
}

}  // namespace harness
