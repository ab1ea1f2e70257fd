/* Counts what a program sends: preloaded by contrib/mpi-count, it stands between the program and MPI (its profiling
   interface). Each rank writes one line per kind of call to $MPI_COUNT_FILE.RANK: name, calls, bytes that this rank
   gave to it, CPU seconds in it. A line "total" has the CPU seconds of the whole process. */
#define _GNU_SOURCE
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum Kind
{
  point_to_point,
  reduction,
  broadcast,
  gather,
  all_to_all,
  barrier,
  waiting,
  n_kinds
};
static const char *const name[n_kinds] = {
  "point-to-point", "reduction", "broadcast", "gather", "all-to-all", "barrier", "waiting"};
static unsigned long calls[n_kinds], bytes[n_kinds];
static double        seconds[n_kinds];

static double now(clockid_t clock)
{
  struct timespec t;
  clock_gettime(clock, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static unsigned long size_of(const long count, MPI_Datatype type)
{
  int size;
  PMPI_Type_size(type, &size);
  return count * (unsigned long)size;
}

static unsigned long sum_of(const int *counts, MPI_Comm communicator)
{
  int           n;
  unsigned long sum = 0;
  PMPI_Comm_size(communicator, &n);
  for (int i = 0; i < n; ++i)
    sum += counts[i];
  return sum;
}

/* A call of this kind that hands over so many bytes. */
#define COUNTED(kind, n_bytes, call)                                                                                   \
  const double start  = now(CLOCK_THREAD_CPUTIME_ID);                                                                  \
  const int    result = call;                                                                                          \
  ++calls[kind];                                                                                                       \
  bytes[kind] += (n_bytes);                                                                                            \
  seconds[kind] += now(CLOCK_THREAD_CPUTIME_ID) - start;                                                               \
  return result;

#define SEND(Name)                                                                                                     \
  int MPI_##Name(const void *data, int n, MPI_Datatype type, int to, int tag, MPI_Comm c)                              \
  {                                                                                                                    \
    COUNTED(point_to_point, size_of(n, type), PMPI_##Name(data, n, type, to, tag, c))                                  \
  }
#define START_SEND(Name)                                                                                               \
  int MPI_##Name(const void *data, int n, MPI_Datatype type, int to, int tag, MPI_Comm c, MPI_Request *request)        \
  {                                                                                                                    \
    COUNTED(point_to_point, size_of(n, type), PMPI_##Name(data, n, type, to, tag, c, request))                         \
  }
SEND(Send)
SEND(Ssend)
SEND(Rsend)
START_SEND(Isend)
START_SEND(Issend)
START_SEND(Irsend)

int MPI_Recv(void *data, int n, MPI_Datatype type, int from, int tag, MPI_Comm c, MPI_Status *status)
{
  COUNTED(waiting, 0, PMPI_Recv(data, n, type, from, tag, c, status))
}
int MPI_Wait(MPI_Request *request, MPI_Status *status)
{
  COUNTED(waiting, 0, PMPI_Wait(request, status))
}
int MPI_Waitall(int n, MPI_Request *requests, MPI_Status *statuses)
{
  COUNTED(waiting, 0, PMPI_Waitall(n, requests, statuses))
}
int MPI_Allreduce(const void *mine, void *all, int n, MPI_Datatype type, MPI_Op op, MPI_Comm c)
{
  COUNTED(reduction, size_of(n, type), PMPI_Allreduce(mine, all, n, type, op, c))
}
int MPI_Reduce(const void *mine, void *all, int n, MPI_Datatype type, MPI_Op op, int root, MPI_Comm c)
{
  COUNTED(reduction, size_of(n, type), PMPI_Reduce(mine, all, n, type, op, root, c))
}
int MPI_Scan(const void *mine, void *all, int n, MPI_Datatype type, MPI_Op op, MPI_Comm c)
{
  COUNTED(reduction, size_of(n, type), PMPI_Scan(mine, all, n, type, op, c))
}
int MPI_Exscan(const void *mine, void *all, int n, MPI_Datatype type, MPI_Op op, MPI_Comm c)
{
  COUNTED(reduction, size_of(n, type), PMPI_Exscan(mine, all, n, type, op, c))
}
int MPI_Bcast(void *data, int n, MPI_Datatype type, int root, MPI_Comm c)
{
  int rank;
  PMPI_Comm_rank(c, &rank);
  COUNTED(broadcast, rank == root ? size_of(n, type) : 0, PMPI_Bcast(data, n, type, root, c))
}
int MPI_Gather(const void *mine, int n, MPI_Datatype type, void *all, int m, MPI_Datatype other, int root, MPI_Comm c)
{
  COUNTED(gather, size_of(n, type), PMPI_Gather(mine, n, type, all, m, other, root, c))
}
int MPI_Allgather(const void *mine, int n, MPI_Datatype type, void *all, int m, MPI_Datatype other, MPI_Comm c)
{
  COUNTED(gather, size_of(n, type), PMPI_Allgather(mine, n, type, all, m, other, c))
}
int MPI_Allgatherv(const void  *mine,
                   int          n,
                   MPI_Datatype type,
                   void        *all,
                   const int   *m,
                   const int   *offsets,
                   MPI_Datatype other,
                   MPI_Comm     c)
{
  COUNTED(gather, size_of(n, type), PMPI_Allgatherv(mine, n, type, all, m, offsets, other, c))
}
int MPI_Alltoall(const void *mine, int n, MPI_Datatype type, void *all, int m, MPI_Datatype other, MPI_Comm c)
{
  int n_ranks;
  PMPI_Comm_size(c, &n_ranks);
  COUNTED(all_to_all, size_of((long)n * n_ranks, type), PMPI_Alltoall(mine, n, type, all, m, other, c))
}
int MPI_Alltoallv(const void  *mine,
                  const int   *n,
                  const int   *from,
                  MPI_Datatype type,
                  void        *all,
                  const int   *m,
                  const int   *to,
                  MPI_Datatype other,
                  MPI_Comm     c)
{
  COUNTED(all_to_all, size_of(sum_of(n, c), type), PMPI_Alltoallv(mine, n, from, type, all, m, to, other, c))
}
int MPI_Barrier(MPI_Comm c)
{
  COUNTED(barrier, 0, PMPI_Barrier(c))
}

int MPI_Finalize(void)
{
  const char *file = getenv("MPI_COUNT_FILE");
  int         rank;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (file)
    {
      char path[4096];
      snprintf(path, sizeof path, "%s.%d", file, rank);
      FILE *out = fopen(path, "w");
      if (out)
        {
          for (int k = 0; k < n_kinds; ++k)
            fprintf(out, "%s,%lu,%lu,%.6f\n", name[k], calls[k], bytes[k], seconds[k]);
          fprintf(out, "total,0,0,%.6f\n", now(CLOCK_PROCESS_CPUTIME_ID));
          fclose(out);
        }
    }
  return PMPI_Finalize();
}
