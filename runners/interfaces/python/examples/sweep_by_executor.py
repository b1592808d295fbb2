"""Does a sweep by the workers of an executor: processes of this machine, Dask or MPI.

    python3 sweep_by_executor.py processes fig4.13 map.h5
    python3 sweep_by_executor.py dask fig4.13 map.h5 tcp://scheduler:8786
    mpirun -n 3 python3 -m mpi4py.futures sweep_by_executor.py mpi fig4.13 map.h5

Without the address of a scheduler, Dask starts workers on this machine. The same command continues where it stopped.
"""
import concurrent.futures
import contextlib
import sys

import remote_touch as rt


@contextlib.contextmanager
def executor_of(engine, *address):
    if engine == "processes":
        with concurrent.futures.ProcessPoolExecutor() as executor:
            yield executor
    elif engine == "dask":
        from distributed import Client
        with Client(*address) as client:
            yield client.get_executor()
    elif engine == "mpi":
        from mpi4py.futures import MPIPoolExecutor
        with MPIPoolExecutor() as executor:
            yield executor
    else:
        sys.exit(f"{engine}: expected processes, dask or mpi")


def main(engine, sweep, output, *address):
    with executor_of(engine, *address) as executor:
        result = rt.sweep(sweep, output=output, executor=executor)
    runs = int(result.runs.sum()) if "runs" in result else result.state.size
    print(f"{output}: {runs} runs, {result.attrs['checked_runs']} of them made twice, "
          f"{result.attrs['checked_by_another_worker']} by another worker")


if __name__ == "__main__":
    main(*sys.argv[1:])
