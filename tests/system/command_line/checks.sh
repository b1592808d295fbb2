# What the tests of the command line share: an empty folder to work in, and checks of what a command does.
# A test begins with `source checks.sh PROGRAM`, and its last command is `finish`.
# shellcheck shell=bash
set -uo pipefail
program=$(realpath "${1:?usage: $0 PROGRAM}") || exit 2
helpers=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
sources=${helpers%/tests/system/command_line}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
# Settings of the user that change what the program does. REMOTE_TOUCH_MUTATION stays, by which scripts/mutate chooses.
unset REMOTE_TOUCH_DATA REMOTE_TOUCH_ISA REMOTE_TOUCH_CACHE_MB "${!REMOTE_TOUCH_LIB@}" SPNAV_SOCKET DISPLAY WAYLAND_DISPLAY
unset OMP_NUM_THREADS OMP_THREAD_LIMIT OMP_DYNAMIC GLIBC_TUNABLES "${!SLURM_@}" "${!OMPI_@}"
export LC_ALL=C

failures=0
pass() { echo "ok      $1"; }
fail() { echo "FAILED  $1: $2"; failures=$((failures + 1)); }
skip() { echo "skipped $1: $2"; }

# is NAME COMMAND...: the command succeeds.
is() {
  local name=$1
  shift
  if "$@" >is.log 2>&1; then pass "$name"; else fail "$name" "$* ($(head -c 300 is.log))"; fi
}

# says NAME TEXT...: the last command printed the texts.
says() {
  local text
  for text in "${@:2}"; do is "$1: '$text'" grep -qF -e "$text" out; done
}
# python NAME ARGUMENT... <<CODE: the code, in which every claim is an assertion.
python() {
  if /usr/bin/python3 - "${@:2}" >log 2>&1; then pass "$1"; else fail "$1" "$(tail -n 5 log)"; fi
}
change() { /usr/bin/python3 "$helpers/change_result" "$@"; }
write_recording() { /usr/bin/python3 "$helpers/write_recording" "$@"; }

# What a slow machine shows of progress every ten seconds is no message: "figures: 1 of 3, making 4.13; about 9 s left",
# "fig4.16:  12 %, 3.1 %/s, 28 s left".
# Thousands of checks use these: what bash does itself takes no process.
without_progress() { [[ ! -s err ]] || sed -i -E '/^remote-touch: /!{/: +[0-9]+ (%|of [0-9])/d}' err; }
is_silent() { without_progress && [[ ! -s err ]]; }

# comes_true COMMAND...: waits until it succeeds. The limit only ends a test that hangs; a busy machine may take minutes.
comes_true() {
  local i
  for ((i = 0; i < 6000; i++)); do
    ! "$@" >/dev/null 2>&1 || return 0
    sleep 0.1
  done
  return 1
}
# takes_signals PID: the program runs there, and its handlers of signals do: an earlier signal would end it without a word.
takes_signals() {
  local caught
  [[ /proc/$1/exe -ef $program ]] && caught=$(sed -n 's/^SigCgt:[[:space:]]*//p' "/proc/$1/status") &&
    ((0x${caught:-0} & 1 << 14))  # SIGTERM
}
# is_under_way PID COMMAND...: it takes signals and the command succeeds; or it has ended, and there is nothing to wait for.
is_under_way() { { takes_signals "$1" && "${@:2}"; } || ! kill -0 "$1"; }

# exits NAME CODE ARGUMENT...: this exit code and a stderr without messages; stdout is kept in the file out.
exits() {
  local name=$1 code=0
  "$program" "${@:3}" >out 2>err || code=$?
  if is_silent && [[ $code -eq $2 ]]; then
    pass "$name"
  else
    fail "$name" "exit $code instead of $2: $(head -c 300 err) $(tail -n 1 out)"
  fi
}
succeeds() { exits "$1" 0 "${@:2}"; }

# The folder made is where every refused command would write.
mkdir made
nothing_left() { ! compgen -G 'made/*' >/dev/null && ! compgen -G 'made/.[!.]*' >/dev/null; }
is_one_message() {
  local lines
  without_progress
  mapfile lines <err
  [[ ${#lines[@]} -eq 1 && ${lines[0]} == 'remote-touch: '*$'\n' ]]
}

# judge_refusal NAME CODE WORD...: exit 2, one line with every word, no file left behind.
judge_refusal() {
  local name=$1 code=$2 word said missing=
  shift 2
  IFS= read -r -d '' said <err
  for word in "$@"; do [[ $said == *"$word"* ]] || missing+=" '$word'"; done
  if [[ $code -ne 2 ]]; then
    fail "$name" "exit $code instead of 2: $(head -c 300 err)"
  elif ! is_one_message; then
    fail "$name" "not one line from remote-touch: $(head -c 300 err)"
  elif [[ -n $missing ]]; then
    fail "$name" "says nothing of$missing: $(<err)"
  elif ! nothing_left; then
    fail "$name" "left $(find made -mindepth 1 | tr '\n' ' ')"
  else
    pass "$name"
  fi
  nothing_left || find made -mindepth 1 -delete
}

# refused NAME WORD... -- ARGUMENT...
refused() {
  local name=$1 words=() code=0
  shift
  while [[ $1 != -- ]]; do words+=("$1") && shift; done
  shift
  "$program" "$@" >out 2>err || code=$?
  judge_refusal "$name" "$code" "${words[@]}"
}
# Of a run that would write made/x.h5.
run_refused() {
  local name=$1 words=()
  shift
  while [[ $1 != -- ]]; do words+=("$1") && shift; done
  shift
  refused "$name" "${words[@]}" -- run "$@" -o made/x.h5
}

digest_of() { "$program" run "$@" -o digest.h5 2>&1 | sed -n 's/.*digest //p'; }
# entries_of SECTION: the names that `list` has in it.
entries_of() { "$program" list | sed -n "/^$1\$/,/^[a-z]/s/^  \([^ ]*\) .*/\1/p"; }

# Tells how it went, and succeeds if every check did.
finish() {
  if [[ $failures -eq 0 ]]; then echo "all as it should be"; else echo "$failures FAILED"; fi
  [[ $failures -eq 0 ]]
}
