// One value for each enumerator, indexed by the enumerator itself:
//
//   enum class Coolant { kOff, kFlood, kMist };
//   constexpr Coolant LastOf(Coolant) { return Coolant::kMist; }   // beside the enum
//   EnumArray<Coolant, double> seconds{};
//   seconds[Coolant::kMist] += 1.0;
//   for (Coolant c : Enumerators<Coolant>()) ...
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

namespace patchmill {

// Number of enumerators of E. They begin at 0, have no gaps, and LastOf(E) names the last one.
template <class E>
constexpr std::size_t CountOf() {
  static_assert(std::is_enum_v<E>);
  return static_cast<std::size_t>(LastOf(E{})) + 1;
}

// All enumerators in their order.
template <class E>
constexpr std::array<E, CountOf<E>()> Enumerators() {
  std::array<E, CountOf<E>()> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<E>(k);
  return all;
}

// An aggregate: EnumArray<E, T>{} has default values, EnumArray<E, T>{{a, b, c}} has these values, in order.
template <class E, class T>
struct EnumArray {
  std::array<T, CountOf<E>()> values;

  constexpr T& operator[](E e) { return values[static_cast<std::size_t>(e)]; }
  constexpr const T& operator[](E e) const { return values[static_cast<std::size_t>(e)]; }
  constexpr auto begin() { return values.begin(); }
  constexpr auto end() { return values.end(); }
  constexpr auto begin() const { return values.begin(); }
  constexpr auto end() const { return values.end(); }
  friend constexpr bool operator==(const EnumArray& a, const EnumArray& b) { return a.values == b.values; }
};

}  // namespace patchmill
