# Sourced by the benchmarks that need Python packages: makes $venv with benchmarks/peers/requirements.txt.
venv=build/peers/venv
if [ ! -x $venv/bin/python ]; then
  # Debian's python3 may come without venv's pip: virtualenv does the same.
  python3 -m venv $venv 2>/dev/null || { rm -rf $venv; virtualenv -q -p python3 $venv; } ||
    { echo "no virtual environment can be made: ./dev setup python3-venv" >&2; exit 4; }
fi
if ! cmp -s benchmarks/peers/requirements.txt $venv/installed.txt; then
  if $venv/bin/pip install -q -r benchmarks/peers/requirements.txt; then
    cp benchmarks/peers/requirements.txt $venv/installed.txt
  else
    while read -r package; do
      $venv/bin/pip install -q "$package" || echo "$package cannot be installed: what needs it is skipped" >&2
    done < benchmarks/peers/requirements.txt
  fi
fi
$venv/bin/python -c 'import numpy' || { echo "without numpy nothing can be judged" >&2; exit 4; }
# One thread per process: CPU times are those of the algorithm.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
