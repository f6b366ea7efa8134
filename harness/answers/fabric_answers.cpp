// Cusick's drape coefficient (BS 5058, ISO 9073-9): the part of the ring between table and rim that
// the shadow of the draped disc covers, measured on real fabrics. A net that cannot stretch along
// warp and weft, with Hookean shear and bending and without what friction between yarns holds, is a
// model of them and no more. Methods that take forces first and keep edges to their lengths after
// that do not come to rest under shear as stiff as a fabric's: one undoes what the other does.
// Their figures then depend on the step; those of implicit springs do not.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "harness/answers/readings.h"
#include "harness/scenes/fabrics.h"

namespace harness {
namespace {

using inextensible::Positions;

// m^2, of all triangles seen from above, what lies over one another once: counted on a grid of
// cells of `cell` m.
double shadow(const Positions& x, const std::vector<std::array<int, 3>>& triangles, double cell) {
  const double left = x.row(0).minCoeff(), front = x.row(2).minCoeff();
  const auto columns = static_cast<int>((x.row(0).maxCoeff() - left) / cell) + 2;
  const auto rows = static_cast<int>((x.row(2).maxCoeff() - front) / cell) + 2;
  std::vector<char> covered(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector2d p(x(0, a) - left, x(2, a) - front), q(x(0, b) - left, x(2, b) - front),
        r(x(0, c) - left, x(2, c) - front);
    const auto side = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                         const Eigen::Vector2d& at) {
      return (to.x() - from.x()) * (at.y() - from.y()) - (to.y() - from.y()) * (at.x() - from.x());
    };
    const auto first = [&](double low) { return std::max(0, static_cast<int>(low / cell)); };
    for (int i = first(std::min({p.y(), q.y(), r.y()}));
         (i + 0.5) * cell <= std::max({p.y(), q.y(), r.y()}); ++i) {
      for (int j = first(std::min({p.x(), q.x(), r.x()}));
           (j + 0.5) * cell <= std::max({p.x(), q.x(), r.x()}); ++j) {
        const Eigen::Vector2d middle((j + 0.5) * cell, (i + 0.5) * cell);
        const double u = side(p, q, middle), v = side(q, r, middle), w = side(r, p, middle);
        if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))
          covered[static_cast<std::size_t>(i * columns + j)] = 1;
      }
    }
  }
  return cell * cell * static_cast<double>(std::count(covered.begin(), covered.end(), 1));
}

class DrapeCoefficient final : public Reading {
 public:
  explicit DrapeCoefficient(const AnswerScene& at)
      : triangles_(at.scene.triangles),
        cell_(at.parameters.at("radius") / 400),
        table_(std::numbers::pi * std::pow(at.parameters.at("table"), 2)) {
    Positions flat = at.scene.start.x;
    flat.row(1).setZero();
    whole_ = shadow(flat, triangles_, cell_);
  }

  void after(const inextensible::State& /*before*/, const inextensible::State& state,
             double /*h*/) override {
    x_ = state.x;
  }
  double value() const override {
    return 100 * (shadow(x_, triangles_, cell_) - table_) / (whole_ - table_);
  }

 private:
  std::vector<std::array<int, 3>> triangles_;
  double cell_, table_, whole_ = 0;  // m, m^2
  Positions x_;
};

KnownAnswer drape_of(const char* name, const Fabric& cloth,
                     double (*measured)(const AnswerScene&)) {
  return {name,
          "cusick",
          {{"n", 61}, {"duration", 2}, {"density", cloth.density}, {"bending", cloth.bending}},
          "drape coefficient (Cusick), %, against that of the real fabric",
          "measured with weight and bending, shear assumed (Matsudaira, Masuda, Wada and Yokura "
          "2015)",
          1e-3,
          {0.005, 0.0025},
          measured,
          [](const AnswerScene& at) -> std::unique_ptr<Reading> {
            return std::make_unique<DrapeCoefficient>(at);
          },
          false,
          true};
}

}  // namespace

std::vector<KnownAnswer> fabric_answers() {
  return {drape_of("drape_of_cotton", fabric("cotton"),
                   [](const AnswerScene&) { return fabric("cotton").drape_coefficient; }),
          drape_of("drape_of_wool", fabric("wool"),
                   [](const AnswerScene&) { return fabric("wool").drape_coefficient; }),
          drape_of("drape_of_faille", fabric("polyester_faille"), [](const AnswerScene&) {
            return fabric("polyester_faille").drape_coefficient;
          })};
}

}  // namespace harness
