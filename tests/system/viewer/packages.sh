# The packages of runners/presentation/page, with those for tests, in a folder of the build; read by the scripts beside this one.

not_tried() { echo "not tried: $*"; exit 77; }

# get_packages SOURCE_DIR WORK_DIR: they are in WORK_DIR/node_modules then; the caller is in WORK_DIR.
get_packages() {
  local page=$1/runners/presentation/page
  command -v npm >/dev/null || not_tried "no npm (scripts/install full)"
  mkdir -p "$2"
  cd "$2"
  cp "$page"/*.json .
  cmp -s package-lock.json node_modules/of.json && return
  npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >npm.log 2>&1 ||
    not_tried "npm could not get its packages: $(head -1 npm.log)"
  cp package-lock.json node_modules/of.json
}
