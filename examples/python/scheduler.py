"""What the scheduler of Dask costs: tasks that do nothing but wait, submitted as `ahv.campaign` submits shards.

Prints the time that a task takes beyond its own work, of 10 000 tasks on two workers, and what follows for long shards.
"""

import sys
import time
from itertools import islice

import distributed

TASKS = 10_000
WORKERS = 2
AHEAD = 4


def work(duration_s: float, number: int) -> int:
    """A shard that takes so long."""
    time.sleep(duration_s)
    return number


def elapsed(client: distributed.Client, tasks: int, duration_s: float) -> float:
    """Time of all tasks, some ahead of each worker."""
    numbers = iter(range(tasks))
    start = time.perf_counter()
    flying = distributed.as_completed(
        [client.submit(work, duration_s, number, pure=False) for number in islice(numbers, AHEAD * WORKERS)]
    )
    for future in flying:
        future.result()
        flying.update(client.submit(work, duration_s, number, pure=False) for number in islice(numbers, 1))
    return time.perf_counter() - start


def main() -> None:
    """Time empty tasks, and tasks of known length."""
    tasks = int(sys.argv[2]) if len(sys.argv) > 2 else TASKS
    cluster = distributed.LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=":0")
    with cluster, distributed.Client(cluster) as client:
        client.wait_for_workers(WORKERS)
        elapsed(client, 100, 0.0)
        empty_s = elapsed(client, tasks, 0.0) / tasks
        few = max(tasks // 100, 10)
        duration_s = 0.2
        busy_s = elapsed(client, few, duration_s)
    print(f"{tasks} empty tasks on {WORKERS} workers: {1e3 * empty_s:.2f} ms a task")
    ideal_s = few * duration_s / WORKERS
    print(f"{few} tasks of {duration_s} s: {busy_s:.2f} s, {100 * (busy_s / ideal_s - 1):.1f} % beyond {ideal_s:.1f} s")
    print(f"one scheduler keeps {10 / empty_s:.0f} workers at work with shards of 10 s")
    print(f"and {100 / empty_s:.0f} with shards of 100 s")


if __name__ == "__main__":
    main()
