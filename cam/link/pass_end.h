// The start or the end of a pass, where a lead or a link meets it.
#pragma once

#include <vector>

#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// Keeps a reference to the pass, which has at least one point. A closed pass ends where it starts.
class PassEnd {
 public:
  static PassEnd Start(const CutterPath& pass) { return {pass, true}; }
  static PassEnd End(const CutterPath& pass) { return {pass, false}; }

  bool is_start() const { return is_start_; }
  Traversal traversal() const { return pass_->traversal; }
  const CutterPoint& point() const;
  const Vec3& center() const { return point().center; }
  // The direction of the cut there, unit length; zero for a pass without length.
  Vec3 Along() const;
  // Ball centres from here along the pass and inwards, over `length` (mm) of it or over the whole pass if
  // that is shorter. The first is center(). The pass is walked backwards from its end.
  std::vector<Vec3> Inwards(double length) const;

 private:
  PassEnd(const CutterPath& pass, bool is_start) : pass_(&pass), is_start_(is_start) {}
  std::size_t Count() const { return pass_->points.size() + (pass_->closed ? 1 : 0); }
  const CutterPoint& Inner(std::size_t k) const;  // the k-th point from this end; 0: point()

  const CutterPath* pass_;
  bool is_start_;
};

}  // namespace patchmill
