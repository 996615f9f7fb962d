#pragma once
/// All changes of a program are compiled into it together. The environment variable MUTANT chooses one by its number.
/// mutate.py puts these functions around operators, numbers and statements of a copy of the sources:
///
///   a < b      a <::mutation::Binary<7>{}< b     change 7 is a <= b, change 8 is a >= b
///   !a         ::mutation::Not<9>{}->*a          change 9 is a
///   a += b     a +=::mutation::Assign<10>{}+= b  change 10 is a -= b
///
/// An operator stays an operator of the same precedence, so no operand has to be found. In a constant expression no
/// change is in force. A change that would not compile is not known, and without effect.

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <initializer_list>
#include <type_traits>
#include <utility>

namespace mutation {

inline constexpr int kMaxChanges = 1 << 15;
inline bool known[kMaxChanges];    ///< the change compiles
inline bool reached[kMaxChanges];  ///< its place was executed since the last clearing

inline int chosen() noexcept {
  static const int number = [] {
    const char* text = std::getenv("MUTANT");
    return text == nullptr ? -1 : std::atoi(text);
  }();
  return number;
}

template <int kId>
struct Known {
  static inline const bool value = known[kId] = true;
};

/// The change `kId` is in force.
template <int kId>
constexpr bool on() noexcept {
  if (std::is_constant_evaluated()) return false;
  (void)&Known<kId>::value;
  reached[kId] = true;
  return chosen() == kId;
}

/// An expression of Eigen is evaluated, so that both forms have one type.
template <typename T>
constexpr auto plain(T&& value) {
  if constexpr (requires { value.eval(); }) {
    return value.eval();
  } else {
    return std::decay_t<T>(std::forward<T>(value));
  }
}

template <int kId>
struct Binary {};
template <typename L, int kId>
struct Left {
  L&& value;
};

#define MUTATION_BINARY(original, first, second)                                          \
  template <typename L, int kId>                                                          \
  constexpr Left<L, kId> operator original(L&& l, Binary<kId>) noexcept {                 \
    return {std::forward<L>(l)};                                                          \
  }                                                                                       \
  template <typename L, int kId, typename R>                                              \
  constexpr auto operator original(Left<L, kId> l, R&& r) {                               \
    using Result = decltype(plain(std::forward<L>(l.value) original std::forward<R>(r))); \
    if constexpr (requires { Result(l.value first r); }) {                                \
      if (on<kId>()) return Result(l.value first r);                                      \
    }                                                                                     \
    if constexpr (requires { Result(l.value second r); }) {                               \
      if (on<kId + 1>()) return Result(l.value second r);                                 \
    }                                                                                     \
    return Result(std::forward<L>(l.value) original std::forward<R>(r));                  \
  }
#define MUTATION_BINARY_ONE(original, first)                                              \
  template <typename L, int kId>                                                          \
  constexpr Left<L, kId> operator original(L&& l, Binary<kId>) noexcept {                 \
    return {std::forward<L>(l)};                                                          \
  }                                                                                       \
  template <typename L, int kId, typename R>                                              \
  constexpr auto operator original(Left<L, kId> l, R&& r) {                               \
    using Result = decltype(plain(std::forward<L>(l.value) original std::forward<R>(r))); \
    if constexpr (requires { Result(l.value first r); }) {                                \
      if (on<kId>()) return Result(l.value first r);                                      \
    }                                                                                     \
    return Result(std::forward<L>(l.value) original std::forward<R>(r));                  \
  }
MUTATION_BINARY(<, <=, >=)
MUTATION_BINARY(<=, <, >)
MUTATION_BINARY(>, >=, <=)
MUTATION_BINARY(>=, >, <)
MUTATION_BINARY_ONE(==, !=)
MUTATION_BINARY_ONE(!=, ==)
MUTATION_BINARY_ONE(+, -)
MUTATION_BINARY_ONE(-, +)
MUTATION_BINARY_ONE(*, /)
MUTATION_BINARY_ONE(/, *)
MUTATION_BINARY_ONE(%, /)
MUTATION_BINARY_ONE(&, |)
MUTATION_BINARY_ONE(|, &)
MUTATION_BINARY_ONE(<<, >>)
MUTATION_BINARY_ONE(>>, <<)

template <int kId>
struct Assign {};
template <typename R, int kId>
struct Right {
  R&& value;
};

#define MUTATION_ASSIGN(original, other)                                   \
  template <int kId, typename R>                                           \
  constexpr Right<R, kId> operator original(Assign<kId>, R&& r) noexcept { \
    return {std::forward<R>(r)};                                           \
  }                                                                        \
  template <typename L, typename R, int kId>                               \
  constexpr L&& operator original(L&& l, Right<R, kId> r) {                \
    if constexpr (requires { l other r.value; }) {                         \
      if (on<kId>()) return l other r.value, std::forward<L>(l);           \
    }                                                                      \
    l original std::forward<R>(r.value);                                   \
    return std::forward<L>(l);                                             \
  }
MUTATION_ASSIGN(+=, -=)
MUTATION_ASSIGN(-=, +=)
MUTATION_ASSIGN(*=, /=)
MUTATION_ASSIGN(/=, *=)
MUTATION_ASSIGN(&=, |=)
MUTATION_ASSIGN(|=, &=)

#define MUTATION_PREFIX(Name, original, other)     \
  template <int kId>                               \
  struct Name {};                                  \
  template <int kId, typename T>                   \
  constexpr auto operator->*(Name<kId>, T&& v) {   \
    using Result = decltype(plain(original v));    \
    if constexpr (requires { Result(other v); }) { \
      if (on<kId>()) return Result(other v);       \
    }                                              \
    return Result(original v);                     \
  }
MUTATION_PREFIX(Not, !, !!)
MUTATION_PREFIX(Minus, -, +)
MUTATION_PREFIX(Complement, ~, +)

template <int kId>
struct Increment {};
template <int kId, typename T>
constexpr T& operator->*(Increment<kId>, T& v) {
  return on<kId>() ? --v : ++v;
}
template <int kId>
struct Decrement {};
template <int kId, typename T>
constexpr T& operator->*(Decrement<kId>, T& v) {
  return on<kId>() ? ++v : --v;
}

/// The initialisation of a constant by this is no constant expression.
template <typename T>
T late(T v) noexcept {
  return v;
}

/// Change kId: the double, 1 in place of 0. Change kId + 1: 0.
template <int kId, typename T>
constexpr T number(T v) noexcept {
  if (on<kId>()) return v == 0 ? T(1) : T(v + v);
  if (v != 0 && on<kId + 1>()) return T(0);
  return v;
}

template <int kId>
constexpr bool flag(bool v) noexcept {
  return on<kId>() ? !v : v;
}

/// Change kId: the opposite. Change kId + 1: never.
template <int kId>
constexpr bool condition(bool v) noexcept {
  if (on<kId>()) return !v;
  if (on<kId + 1>()) return false;
  return v;
}

#define MUTATION_EXTREME(Name, original, other)                                                               \
  template <int kId, typename T = void>                                                                       \
  struct Name {                                                                                               \
    constexpr T operator()(const T& a, const T& b) const { return on<kId>() ? other(a, b) : original(a, b); } \
  };                                                                                                          \
  template <int kId>                                                                                          \
  struct Name<kId, void> {                                                                                    \
    template <typename T>                                                                                     \
    constexpr T operator()(const T& a, const T& b) const {                                                    \
      return on<kId>() ? other(a, b) : original(a, b);                                                        \
    }                                                                                                         \
    template <typename T>                                                                                     \
    constexpr T operator()(std::initializer_list<T> list) const {                                             \
      return on<kId>() ? other(list) : original(list);                                                        \
    }                                                                                                         \
  };
MUTATION_EXTREME(Min, std::min, std::max)
MUTATION_EXTREME(Max, std::max, std::min)

/// Without the magnitude a number is itself, a complex one its real part.
template <int kId>
struct Abs {
  template <typename T>
  constexpr auto operator()(const T& v) const {
    using Result = decltype(std::abs(v));
    if constexpr (std::is_same_v<T, std::complex<Result>>) {
      return on<kId>() ? v.real() : std::abs(v);
    } else {
      return on<kId>() ? Result(v) : std::abs(v);
    }
  }
};

#define MUTATION_FUNCTION(Name, original, other)         \
  template <int kId>                                     \
  struct Name {                                          \
    template <typename T>                                \
    constexpr auto operator()(const T& v) const {        \
      using Result = decltype(original(v));              \
      return on<kId>() ? Result(other(v)) : original(v); \
    }                                                    \
  };
MUTATION_FUNCTION(Sin, std::sin, std::cos)
MUTATION_FUNCTION(Cos, std::cos, std::sin)
MUTATION_FUNCTION(Floor, std::floor, std::ceil)
MUTATION_FUNCTION(Ceil, std::ceil, std::floor)
MUTATION_FUNCTION(IsFinite, std::isfinite, true ||)

template <int kId, typename T = void>
struct Clamp {
  constexpr T operator()(const T& v, const T& low, const T& high) const {
    return on<kId>() ? v : std::clamp(v, low, high);
  }
};
template <int kId>
struct Clamp<kId, void> {
  template <typename T>
  constexpr T operator()(const T& v, const T& low, const T& high) const {
    return on<kId>() ? v : std::clamp(v, low, high);
  }
};

template <int kId>
struct CopySign {
  template <typename T>
  constexpr T operator()(const T& v, const T& sign) const {
    return on<kId>() ? v : std::copysign(v, sign);
  }
};

}  // namespace mutation
