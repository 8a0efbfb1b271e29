# Helpers of the end-to-end cases. Sourced.

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# expect_exit CODE COMMAND…: its output goes to stdout.txt and stderr.txt.
expect_exit() {
  local expected=$1 code=0
  shift
  "$@" >stdout.txt 2>stderr.txt || code=$?
  [ "$code" -eq "$expected" ] || fail "exit $code instead of $expected: $* ($(head -n 3 stderr.txt))"
}

# expect_error OUTPUT TEXT COMMAND…: exit 1 with exactly one line that holds TEXT, nothing on standard output, and no
# OUTPUT made.
expect_error() {
  local output=$1 text=$2
  shift 2
  [ -n "$text" ] || fail "any text would do: $*"
  expect_exit 1 "$@"
  [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "not one line: $*: $(cat stderr.txt)"
  grep -q '^chiaro: error: ' stderr.txt || fail "no 'chiaro: error:': $*: $(cat stderr.txt)"
  grep -qi -- "$text" stderr.txt || fail "no '$text': $*: $(cat stderr.txt)"
  [ ! -s stdout.txt ] || fail "something on standard output: $*"
  [ ! -e "$output" ] || fail "$output was made: $*"
  expect_no_leftovers
}

# handles_signals PID: it is past the start of the program.
handles_signals() {
  local caught
  caught=$(sed -n 's/^SigCgt:\t//p' "/proc/$1/status" 2>/dev/null) || return 0
  [ -z "$caught" ] || [ $((0x$caught & 2)) -ne 0 ]
}

# Files that were being written aside and stayed.
expect_no_leftovers() {
  local found
  found=$(find . -name '.*' -type f)
  [ -z "$found" ] || fail "left behind: $found"
}

# json KEYS FILE: a value, as Python prints it: json error.relative_l2 solve.json
json() {
  python3 -c '
import json, sys
value = json.load(open(sys.argv[2]))
for key in sys.argv[1].split("."):
    value = value[int(key)] if isinstance(value, list) else value[key]
print(value)' "$1" "$2"
}

# expect_true EXPRESSION: of Python.
expect_true() {
  python3 -c "import sys; sys.exit(0 if ($1) else 1)" || fail "not true: $1"
}

expect_same() {
  cmp "$1" "$2" || fail "$1 and $2 differ"
}
