/* A solver of your own for bench, in C or any language that can make a shared library with C
 * functions. This file is all that it needs (C99):
 *
 *   cc -O2 -shared -fPIC my_solver.c -o my_solver.so
 *   bench --plugin ./my_solver.so check --solver my_solver
 *
 * The library defines one function, inextensible_plugin, which returns a table of methods. A method
 * makes an object for a scene, takes steps with it, and destroys it. Several objects may exist at
 * once; all calls come from one thread. docs/plugins.md has a solver in 60 lines.
 *
 * Units are SI. Vectors are three doubles, x y z, one after the other. Vertices are counted from 0.
 * Structs grow at their end only: INEXTENSIBLE_ABI changes when an old plug-in would break.
 *
 * SPDX-License-Identifier: MIT
 *
 * Copyright 2026 the inextensible authors
 *
 * Permission is hereby granted, free of charge, to any person obtaining a copy of this file, to
 * deal in it without restriction, including without limitation the rights to use, copy, modify,
 * merge, publish, distribute, sublicense, and/or sell copies of it, and to permit persons to whom
 * it is furnished to do so, subject to the following condition: the above copyright notice and this
 * permission notice shall be included in all copies or substantial portions of it. It is provided
 * "as is", without warranty of any kind, express or implied, including but not limited to the
 * warranties of merchantability, fitness for a particular purpose and noninfringement. In no event
 * shall the authors or copyright holders be liable for any claim, damages or other liability,
 * whether in an action of contract, tort or otherwise, arising from, out of or in connection with
 * it or the use of it. */
#ifndef INEXTENSIBLE_H
#define INEXTENSIBLE_H

#include <stdint.h> /* NOLINT: C has no <cstdint> */

#define INEXTENSIBLE_ABI 1

#ifdef __cplusplus
extern "C" {
#endif

/* ---- What a method is given ---- */

/* A scene. The arrays live as long as the object that is made for it, but for x and v. An array
 * without elements may be NULL. */
typedef struct InextensibleScene {
  uint64_t size; /* of this struct in the bench that calls; later fields are missing there */
  int32_t vertices, edges, springs, stencils, body_vertices, body_triangles;
  double strain_limit; /* the largest |length / rest_length - 1| of an edge that is permitted */
  uint64_t seed;       /* of random numbers */
  double gravity[3];   /* m/s^2 */
  const double* mass;  /* kg, one a vertex; 0: pinned, no force moves it */
  const double* x;     /* m and m/s, 3 a vertex: where the first step begins. Valid during create */
  const double* v;     /* only, and NULL where that is not known. */

  const int32_t* edge;       /* 2 an edge: the vertices that it joins */
  const double* rest_length; /* m, one an edge */

  const int32_t* spring; /* 2 a spring, of shear; energy stiffness / 2 (length - rest length)^2 */
  const double* spring_length;    /* m */
  const double* spring_stiffness; /* N/m */

  /* Bending: energy stiffness / 2 |sum_i coefficient_i x_i|^2 (Bergou et al. 2006). */
  const int32_t* stencil;            /* 4 a stencil: vertices */
  const double* stencil_coefficient; /* 4 a stencil; 0: no such vertex */
  const double* stencil_stiffness;   /* one a stencil */

  const double* drag; /* N s/m, one a vertex: force -drag v; NULL: none */

  /* The body that cloth lies on: a closed triangle mesh, seen counterclockwise from outside. */
  const double* body_vertex;    /* m, 3 a vertex, in the body's own frame */
  const int32_t* body_triangle; /* 3 a triangle */
  double friction;              /* Coulomb's coefficient */
  int32_t body_moves;           /* not 0: InextensibleStep.pose says where it is */

  /* Not 0: this object is asked to correct edges along their middles, halfway between the start of
   * the step and now (of methods with INEXTENSIBLE_TAKES_MIDDLE). */
  int32_t along_middle;
} InextensibleScene;

/* A step, from `time` to `time + h`. */
typedef struct InextensibleStep {
  uint64_t size; /* as of InextensibleScene */
  double h, time;
  /* A step replaces x and v at its start by those at its end. For a filter, x is the
   * candidate, which it moves to positions that keep the limit; v is NULL. Pinned vertices are
   * where they end the step; what is written to them is ignored. */
  double *x, *v;
  const double* x_start; /* for a filter: positions at the start of the step; else NULL */
  const double* force;   /* N, 3 a vertex: shear, bending and drag at the start of the step, of
                            methods with INEXTENSIBLE_WANTS_FORCES; NULL: the scene has none */
  const double* pose;    /* the body at the end of the step: three rows of a rotation with a fourth
                            column, the translation; NULL: it does not move */
  /* A filter calls it: it moves vertices of x that have gone through their contact planes back
   * onto them. NULL where nothing can be touched. The result of a filter must not need it. */
  void (*settle)(struct InextensibleStep* step);

  /* What the method may write; 0 at first. */
  int64_t iterations, edge_projections, assemblies, factorizations, back_solves; /* of this step */
  double copy_seconds; /* of the call: to bring x and v to an engine and back, if it is known */
  const char* reason;  /* why a step is refused: a literal */
} InextensibleStep;

/* ---- What a method says of itself ---- */

enum InextensibleResult { /* of a step. Where it is refused, x and v do not matter. */
                          INEXTENSIBLE_OK = 0,
                          INEXTENSIBLE_NOT_CONVERGED,
                          INEXTENSIBLE_SINGULAR, /* a linear system cannot be solved */
                          INEXTENSIBLE_NOT_FINITE
};

enum InextensibleKind {
  INEXTENSIBLE_STEP = 0, /* a time step of its own: x and v in, x and v out */
  INEXTENSIBLE_FILTER    /* a velocity filter: moves a candidate onto the constraints. bench puts it
                            into each of its time steppers, and treats all other forces. */
};

enum InextensibleFlag {                                  /* may be added up */
                        INEXTENSIBLE_TAKES_COLLIDER = 1, /* scenes with a body */
                        INEXTENSIBLE_TAKES_SHEAR =
                            2, /* scenes with springs. A filter takes this and the next two */
                        INEXTENSIBLE_TAKES_BENDING =
                            4, /* without saying so, for bench treats them. */
                        INEXTENSIBLE_TAKES_DRAG = 8,
                        INEXTENSIBLE_TAKES_STIFF_FORCES =
                            16, /* scenes that want these implicitly in long steps */
                        INEXTENSIBLE_WANTS_FORCES = 32,
                        INEXTENSIBLE_TAKES_MIDDLE = 64,
                        INEXTENSIBLE_WHOLE_STEP =
                            128, /* x and v belong to one instant; else v is that of the middle of
                                    the step before, as in symplectic and backward Euler */
                        INEXTENSIBLE_NO_LIMIT =
                            256, /* promises no strain limit: is run at each step and judged */
                        INEXTENSIBLE_MOMENTUM =
                            512, /* conserves momentum however far it iterates */
                        INEXTENSIBLE_ENGINE =
                            1024 /* a program that others wrote; bench marks it as such */
};

enum InextensibleDirection { /* of constraint forces: along the edges ... */
                             INEXTENSIBLE_UNKNOWN = 0,
                             INEXTENSIBLE_LOCAL,   /* each from its own ends in turn */
                             INEXTENSIBLE_START,   /* at the start of the step */
                             INEXTENSIBLE_CURRENT, /* at the current iterate */
                             INEXTENSIBLE_END      /* at the end of the step */
};

/* A setting: a number, or one of several words. `bench tune` searches those with a search range. */
typedef struct InextensibleSetting {
  const char *name, *meaning;
  double initial;
  double least, largest;               /* both 0: any number */
  double search_least, search_largest; /* both 0: not searched */
  int32_t whole;                       /* not 0: whole numbers only */
  const char* const* words; /* NULL, or words up to a NULL: the value is a word's place, from 0 */
} InextensibleSetting;

typedef struct InextensibleMethod {
  const char* name;     /* a-z, 0-9 and _ */
  const char* summary;  /* one line */
  const char* label;    /* in figures; NULL: the name */
  const char* citation; /* author and year, or NULL */
  int32_t kind;         /* InextensibleKind */
  int32_t flags;        /* InextensibleFlag */
  int32_t direction;    /* InextensibleDirection */
  int32_t setting_count;
  const InextensibleSetting* settings;
  /* Makes an object; `settings` has a value for each setting. NULL: it does not take the scene, and
   * *reason, a literal, says why. */
  void* (*create)(const InextensibleScene* scene, const double* settings, const char** reason);
  /* Returns an InextensibleResult. A refusal leaves nothing behind in the object. */
  int (*step)(void* object, InextensibleStep* step);
  void (*destroy)(void* object);
} InextensibleMethod;

/* The table. It and all that it points to live until the program ends. */
typedef struct InextensiblePlugin {
  uint32_t abi, method_size, setting_size, optimized; /* INEXTENSIBLE_BUILD */
  const char* version;                                /* of the plug-in: printable ASCII */
  int32_t method_count;
  const InextensibleMethod* methods;
} InextensiblePlugin;

#ifdef __OPTIMIZE__
#define INEXTENSIBLE_OPTIMIZED 1
#else
#define INEXTENSIBLE_OPTIMIZED 0
#endif
/* The first four fields of the table. */
#define INEXTENSIBLE_BUILD \
  INEXTENSIBLE_ABI, sizeof(InextensibleMethod), sizeof(InextensibleSetting), INEXTENSIBLE_OPTIMIZED

/* The one symbol that bench looks for; the plug-in defines it. */
#ifdef __GNUC__
__attribute__((visibility("default")))
#endif
const InextensiblePlugin*
inextensible_plugin(void);

#ifdef __cplusplus
}
#endif

#endif
