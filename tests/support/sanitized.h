// Whether this build runs under AddressSanitizer or ThreadSanitizer: times are several times longer then.
#pragma once

namespace patchmill::testing {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace patchmill::testing
