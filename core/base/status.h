// Errors that input can cause are absl::Status; checks for our own bugs abort.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

// Returns the status of `expr` from the calling function when it is not OK.
#define PM_RETURN_IF_ERROR(expr)                                            \
  do {                                                                      \
    if (absl::Status pm_status = (expr); !pm_status.ok()) return pm_status; \
  } while (false)

#define PM_CONCAT_(a, b) a##b
#define PM_CONCAT(a, b) PM_CONCAT_(a, b)
#define PM_ASSIGN_OR_RETURN_(tmp, lhs, expr) \
  auto tmp = (expr);                         \
  if (!tmp.ok()) return tmp.status();        \
  lhs = std::move(*tmp)
// PM_ASSIGN_OR_RETURN(auto x, F()): x is the value of F(), or the calling function returns the status of F().
#define PM_ASSIGN_OR_RETURN(lhs, expr) PM_ASSIGN_OR_RETURN_(PM_CONCAT(pm_or_, __LINE__), lhs, expr)

// Checks a condition that our own code must keep, whatever the input. Aborts with the place if it does not
// hold.
#define PM_CHECK(condition)                                                                       \
  do {                                                                                            \
    if (!(condition)) {                                                                           \
      std::fprintf(stderr, "%s:%d: internal check failed: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                               \
    }                                                                                             \
  } while (false)
