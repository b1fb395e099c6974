#!/usr/bin/env bash
# Reads from finished programs that they are hardened as cmake/Toolchain.cmake says: position independent, tables of
# addresses read-only from the start, no executable stack, checked stacks and calls of libc, marked targets of indirect
# jumps.
#   tests/operations/hardening.sh [--optimized] PROGRAM...
# --optimized: the programs were built with optimization, without which libc's checked calls do not exist.
set -euo pipefail
optimized=no
if [ "${1:-}" = --optimized ]; then optimized=yes; shift; fi
[ "$#" -gt 0 ] || { echo "hardening: name the programs to read" >&2; exit 2; }

failed=0
for program in "$@"; do
  fails() { echo "hardening: $program $1" >&2; failed=1; }
  [ -f "$program" ] || { fails "is not there"; continue; }
  header=$(readelf -hW "$program")
  segments=$(readelf -lW "$program")
  dynamic=$(readelf -dW "$program")
  symbols=$(readelf --dyn-syms -W "$program")
  grep -Eq 'Type: +DYN' <<< "$header" || fails "has fixed addresses (-pie is missing)"
  grep -Eq 'FLAGS_1.*\bPIE\b' <<< "$dynamic" || fails "is not marked as position independent (-pie is missing)"
  grep -q GNU_RELRO <<< "$segments" || fails "has tables of addresses that stay writable (-z relro is missing)"
  grep -Eq 'FLAGS_1.*\bNOW\b' <<< "$dynamic" || fails "resolves symbols while it runs (-z now is missing)"
  grep -Eq 'GNU_STACK .* RW +0x' <<< "$segments" || fails "has an executable stack"
  grep -Eq '\(TEXTREL\)|\(RPATH\)' <<< "$dynamic" && fails "writes into its code or has an RPATH"
  grep -q __stack_chk_fail <<< "$symbols" || fails "does not check its stack (-fstack-protector-strong is missing)"
  if [ "$optimized" = yes ]; then
    grep -Eq '__[a-z]+_chk@' <<< "$symbols" || fails "does not check calls of libc (-D_FORTIFY_SOURCE=2 is missing)"
  fi
  if grep -q X86-64 <<< "$header"; then
    # The first instruction of main() stands for all: libc calls main() by a pointer.
    main=$(objdump -d --no-show-raw-insn --disassemble=main "$program" | grep -A1 '<main>:' || true)
    grep -q endbr64 <<< "$main" || fails "has unmarked targets of indirect jumps (-fcf-protection is missing)"
  fi
done
[ "$failed" -eq 0 ] && echo "hardening: $# programs are hardened"
exit "$failed"
