// The row of each method; registry.cpp lists them.
#pragma once

#include "solvers/methods/backend.h"

namespace inextensible {

Backend implicit_springs_row();
Backend jacobi_row();
Backend gauss_seidel_row();
Backend gauss_seidel_colored_row();
Backend shake_row();
Backend icd_row();
Backend fast_projection_row();
Backend rattle_row();
Backend yarn_projection_row();
Backend fast_projection_adaptive_row();
Backend pbd_substeps_row();
Backend vertex_block_descent_row();
Backend augmented_vbd_row();
Backend admm_row();
Backend soft_step_row();
Backend null_row();
Backend dense_newton_row();

}  // namespace inextensible
