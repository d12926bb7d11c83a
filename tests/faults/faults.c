// Preloaded into a program (LD_PRELOAD), makes the n-th call of a kind go wrong, or counts the calls. What tests set:
//
//   TREAD_FAULT="KIND N"    the N-th call of that kind goes wrong, from 1; 0: none
//   TREAD_FAULT_RANK=R      on rank R alone, of several that mpirun starts; 0 without it
//   TREAD_FAULT_BELOW=DIR   calls on files count below this directory alone
//   TREAD_FAULT_COUNTS=FILE at the end "KIND COUNT" lines are appended there
//
// Kinds: write, fsync, rename, open, close, truncate, allocation, message; launch (of a kernel on a GPU), device_memory
// (an allocation there); quota lets no write succeed from the n-th on; kill ends the process before its n-th call of
// any kind that touches files; clock sets the wall clock a day ahead from its n-th reading on, clock_back a day back.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <mpi.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

enum kind
{
    WRITE,
    QUOTA,
    FSYNC,
    RENAME,
    OPEN,
    CLOSE,
    TRUNCATE,
    ALLOCATION,
    MESSAGE,
    LAUNCH,
    DEVICE_MEMORY,
    KILL,
    CLOCK,
    CLOCK_BACK,
    KINDS
};

static const char* const names[KINDS] = {"write",         "quota",    "fsync",      "rename",    "open",
                                         "close",         "truncate", "allocation", "message",   "launch",
                                         "device_memory", "kill",     "clock",      "clock_back"};

static atomic_long counts[KINDS];
static enum kind   wanted_kind = KINDS;
static long        wanted_call;
static const char* below;
static const char* counts_file;
static const long  day = 86400;

__attribute__((constructor)) static void begin(void)
{
    const char* rank      = getenv("OMPI_COMM_WORLD_RANK");
    const char* with_rank = getenv("TREAD_FAULT_RANK");
    if (strcmp(rank ? rank : "0", with_rank ? with_rank : "0") != 0) { return; }
    const char* fault = getenv("TREAD_FAULT");
    below             = getenv("TREAD_FAULT_BELOW");
    counts_file       = getenv("TREAD_FAULT_COUNTS");
    char name[32];
    long call = 0;
    if (fault && sscanf(fault, "%31s %ld", name, &call) == 2)
    {
        for (int kind = 0; kind < KINDS; ++kind)
        {
            if (strcmp(name, names[kind]) == 0)
            {
                wanted_call = call;
                wanted_kind = (enum kind)kind;
            }
        }
    }
}

__attribute__((destructor)) static void end(void)
{
    if (!counts_file) { return; }
    const int file = (int)syscall(SYS_openat, AT_FDCWD, counts_file, O_WRONLY | O_CREAT | O_APPEND, 0644);
    for (int kind = 0; kind < KINDS; ++kind)
    {
        char      line[64];
        const int size = snprintf(line, sizeof line, "%s %ld\n", names[kind], (long)counts[kind]);
        if (syscall(SYS_write, file, line, size) != size) { return; }
    }
    syscall(SYS_close, file);
}

/// Counts a call; whether it has to go wrong.
static int goes_wrong(enum kind kind)
{
    const long call = ++counts[kind];
    return kind == wanted_kind && call == wanted_call;
}

static int is_below(const char* path) { return below && strncmp(path, below, strlen(below)) == 0; }

/// The same of a call on a file, which also counts as a place to be killed at.
static int file_goes_wrong(enum kind kind, const char* path)
{
    if (!is_below(path)) { return 0; }
    if (goes_wrong(KILL)) { syscall(SYS_kill, syscall(SYS_getpid), SIGKILL); }
    return goes_wrong(kind);
}

/// The path of an open file; empty if it has none.
static const char* path_of(int descriptor, char path[PATH_MAX])
{
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const ssize_t size        = syscall(SYS_readlinkat, AT_FDCWD, link, path, PATH_MAX - 1);
    path[size < 0 ? 0 : size] = 0;
    return path;
}

static int descriptor_goes_wrong(enum kind kind, int descriptor)
{
    char path[PATH_MAX];
    return file_goes_wrong(kind, path_of(descriptor, path));
}

static int fails(int reason)
{
    errno = reason;
    return -1;
}

/// Why a write to a file fails; 0: it does not. A quota that is used up stays so.
static int refusal_of_write(int descriptor)
{
    char path[PATH_MAX];
    if (!is_below(path_of(descriptor, path))) { return 0; }
    const int used_up = wanted_kind == QUOTA && wanted_call > 0 && ++counts[QUOTA] >= wanted_call;
    return used_up ? EDQUOT : file_goes_wrong(WRITE, path) ? ENOSPC : 0;
}

#define NEXT(function) ((__typeof__(&function))dlsym(RTLD_NEXT, #function))

ssize_t write(int file, const void* data, size_t size)
{
    const int refusal = refusal_of_write(file);
    return refusal ? fails(refusal) : syscall(SYS_write, file, data, size);
}

ssize_t pwrite(int file, const void* data, size_t size, off_t place)
{
    const int refusal = refusal_of_write(file);
    return refusal ? fails(refusal) : syscall(SYS_pwrite64, file, data, size, place);
}

ssize_t pwrite64(int file, const void* data, size_t size, off64_t place) { return pwrite(file, data, size, place); }

ssize_t writev(int file, const struct iovec* parts, int count)
{
    const int refusal = refusal_of_write(file);
    return refusal ? fails(refusal) : syscall(SYS_writev, file, parts, count);
}

size_t fwrite(const void* data, size_t size, size_t count, FILE* file)
{
    const int refusal = refusal_of_write(fileno(file));
    if (refusal)
    {
        errno = refusal;
        return 0;
    }
    return NEXT(fwrite)(data, size, count, file);
}

int fflush(FILE* file)
{
    const int refusal = file ? refusal_of_write(fileno(file)) : 0;
    return refusal ? fails(refusal) : NEXT(fflush)(file);
}

int fallocate(int file, int mode, off_t place, off_t size)
{
    const int refusal = refusal_of_write(file);
    return refusal ? fails(refusal) : (int)syscall(SYS_fallocate, file, mode, place, size);
}

int fallocate64(int file, int mode, off64_t place, off64_t size) { return fallocate(file, mode, place, size); }

int fsync(int file) { return descriptor_goes_wrong(FSYNC, file) ? fails(EIO) : (int)syscall(SYS_fsync, file); }

int fdatasync(int file) { return descriptor_goes_wrong(FSYNC, file) ? fails(EIO) : (int)syscall(SYS_fdatasync, file); }

int rename(const char* from, const char* to)
{
    return file_goes_wrong(RENAME, to) ? fails(EIO) : (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}

static int opened(int directory, const char* path, int flags, va_list rest)
{
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;
    if ((flags & O_ACCMODE) != O_RDONLY && file_goes_wrong(OPEN, path)) { return fails(EACCES); }
    return (int)syscall(SYS_openat, directory, path, flags, mode);
}

#define OPENS(signature, directory)                                                                                    \
    signature                                                                                                          \
    {                                                                                                                  \
        va_list rest;                                                                                                  \
        va_start(rest, flags);                                                                                         \
        const int made = opened(directory, path, flags, rest);                                                         \
        va_end(rest);                                                                                                  \
        return made;                                                                                                   \
    }

OPENS(int open(const char* path, int flags, ...), AT_FDCWD)
OPENS(int open64(const char* path, int flags, ...), AT_FDCWD)
OPENS(int openat(int directory, const char* path, int flags, ...), directory)
OPENS(int openat64(int directory, const char* path, int flags, ...), directory)

int close(int file)
{
    const int wrong = descriptor_goes_wrong(CLOSE, file);
    const int done  = (int)syscall(SYS_close, file);
    return wrong ? fails(EIO) : done;
}

int ftruncate(int file, off_t size)
{
    return descriptor_goes_wrong(TRUNCATE, file) ? fails(EIO) : (int)syscall(SYS_ftruncate, file, size);
}

int ftruncate64(int file, off64_t size) { return ftruncate(file, size); }

void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* old, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

static void* none(void)
{
    errno = ENOMEM;
    return NULL;
}

void* malloc(size_t size) { return goes_wrong(ALLOCATION) ? none() : __libc_malloc(size); }

void* calloc(size_t count, size_t size) { return goes_wrong(ALLOCATION) ? none() : __libc_calloc(count, size); }

void* realloc(void* old, size_t size) { return goes_wrong(ALLOCATION) ? none() : __libc_realloc(old, size); }

void* aligned_alloc(size_t alignment, size_t size)
{
    return goes_wrong(ALLOCATION) ? none() : __libc_memalign(alignment, size);
}

int posix_memalign(void** place, size_t alignment, size_t size)
{
    if (goes_wrong(ALLOCATION)) { return ENOMEM; }
    *place = __libc_memalign(alignment, size);
    return *place ? 0 : ENOMEM;
}

#define MESSAGES(function, signature, arguments)                                                                       \
    int function signature { return goes_wrong(MESSAGE) ? MPI_ERR_OTHER : P##function arguments; }

MESSAGES(MPI_Allreduce, (const void* in, void* out, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c), (in, out, n, t, o, c))
MESSAGES(MPI_Allgather, (const void* in, int n, MPI_Datatype t, void* out, int m, MPI_Datatype u, MPI_Comm c),
         (in, n, t, out, m, u, c))
MESSAGES(MPI_Allgatherv,
         (const void* in, int n, MPI_Datatype t, void* out, const int* m, const int* d, MPI_Datatype u, MPI_Comm c),
         (in, n, t, out, m, d, u, c))
MESSAGES(MPI_Alltoall, (const void* in, int n, MPI_Datatype t, void* out, int m, MPI_Datatype u, MPI_Comm c),
         (in, n, t, out, m, u, c))
MESSAGES(MPI_Alltoallv,
         (const void* in, const int* n, const int* e, MPI_Datatype t, void* out, const int* m, const int* d,
          MPI_Datatype u, MPI_Comm c),
         (in, n, e, t, out, m, d, u, c))
MESSAGES(MPI_Barrier, (MPI_Comm c), (c))
MESSAGES(MPI_Ibarrier, (MPI_Comm c, MPI_Request* r), (c, r))
MESSAGES(MPI_Bcast, (void* b, int n, MPI_Datatype t, int root, MPI_Comm c), (b, n, t, root, c))
MESSAGES(MPI_Irecv, (void* b, int n, MPI_Datatype t, int from, int tag, MPI_Comm c, MPI_Request* r),
         (b, n, t, from, tag, c, r))
MESSAGES(MPI_Isend, (const void* b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request* r),
         (b, n, t, to, tag, c, r))
MESSAGES(MPI_Test, (MPI_Request * r, int* flag, MPI_Status* s), (r, flag, s))
MESSAGES(MPI_Waitall, (int n, MPI_Request* r, MPI_Status* s), (n, r, s))

static long jump(void)
{
    ++counts[CLOCK];
    ++counts[CLOCK_BACK];
    const int jumps = (wanted_kind == CLOCK && counts[CLOCK] >= wanted_call) ||
                      (wanted_kind == CLOCK_BACK && counts[CLOCK_BACK] >= wanted_call);
    return !jumps || wanted_call == 0 ? 0 : wanted_kind == CLOCK ? day : -day;
}

int clock_gettime(clockid_t clock, struct timespec* now)
{
    const int done = (int)syscall(SYS_clock_gettime, clock, now);
    if (clock == CLOCK_REALTIME) { now->tv_sec += jump(); }
    return done;
}

int gettimeofday(struct timeval* restrict now, void* restrict zone)
{
    (void)zone;
    struct timespec exact;
    const int       done = clock_gettime(CLOCK_REALTIME, &exact);
    now->tv_sec          = exact.tv_sec;
    now->tv_usec         = exact.tv_nsec / 1000;
    return done;
}

time_t time(time_t* place)
{
    struct timespec exact;
    clock_gettime(CLOCK_REALTIME, &exact);
    if (place) { *place = exact.tv_sec; }
    return exact.tv_sec;
}

// The CUDA runtime is linked into the program and looks the driver's functions up by name, so what it finds is
// replaced.
enum
{
    DRIVER_OUT_OF_MEMORY      = 2,
    DRIVER_LAUNCH_OUT_OF_ROOM = 701
};

#define DRIVER_CALL(name, kind, error, signature, arguments)                                                           \
    static int(*driver_##name) signature;                                                                              \
    static int faulty_##name signature { return goes_wrong(kind) ? error : driver_##name arguments; }

DRIVER_CALL(cuLaunchKernel, LAUNCH, DRIVER_LAUNCH_OUT_OF_ROOM,
            (void* f, unsigned gx, unsigned gy, unsigned gz, unsigned bx, unsigned by, unsigned bz, unsigned shared,
             void* stream, void** parameters, void** extra),
            (f, gx, gy, gz, bx, by, bz, shared, stream, parameters, extra))
DRIVER_CALL(cuLaunchKernelEx, LAUNCH, DRIVER_LAUNCH_OUT_OF_ROOM,
            (const void* shape, void* f, void** parameters, void** extra), (shape, f, parameters, extra))
DRIVER_CALL(cuLaunchCooperativeKernel, LAUNCH, DRIVER_LAUNCH_OUT_OF_ROOM,
            (void* f, unsigned gx, unsigned gy, unsigned gz, unsigned bx, unsigned by, unsigned bz, unsigned shared,
             void* stream, void** parameters),
            (f, gx, gy, gz, bx, by, bz, shared, stream, parameters))
DRIVER_CALL(cuMemAlloc, DEVICE_MEMORY, DRIVER_OUT_OF_MEMORY, (void* place, size_t size), (place, size))
DRIVER_CALL(cuMemAllocAsync, DEVICE_MEMORY, DRIVER_OUT_OF_MEMORY, (void* place, size_t size, void* stream),
            (place, size, stream))
DRIVER_CALL(cuMemAllocFromPoolAsync, DEVICE_MEMORY, DRIVER_OUT_OF_MEMORY,
            (void* place, size_t size, void* pool, void* stream), (place, size, pool, stream))

#define REPLACE(name)                                                                                                  \
    if (strcmp(symbol, #name) == 0)                                                                                    \
    {                                                                                                                  \
        memcpy(&driver_##name, function, sizeof(void*));                                                               \
        *function = (void*)faulty_##name;                                                                              \
    }

static int (*driver_lookup)(const char*, void**, int, unsigned long, void*);

static int lookup(const char* symbol, void** function, int version, unsigned long flags, void* found)
{
    const int result = driver_lookup(symbol, function, version, flags, found);
    if (result != 0 || !*function) { return result; }
    if (strcmp(symbol, "cuGetProcAddress") == 0)
    {
        memcpy(&driver_lookup, function, sizeof(void*));
        *function = (void*)lookup;
    }
    REPLACE(cuLaunchKernel)
    REPLACE(cuLaunchKernelEx)
    REPLACE(cuLaunchCooperativeKernel)
    REPLACE(cuMemAlloc)
    REPLACE(cuMemAllocAsync)
    REPLACE(cuMemAllocFromPoolAsync)
    return result;
}

#ifdef __x86_64__
static const char first_glibc[] = "GLIBC_2.2.5";
#else
static const char first_glibc[] = "GLIBC_2.17";
#endif

// Optimised, so that the last call is a jump: dlsym looks at who called it.
__attribute__((optimize("O2"))) void* dlsym(void* restrict library, const char* restrict symbol)
{
    static void* (*next)(void*, const char*);
    if (!next)
    {
        void* found = dlvsym(RTLD_NEXT, "dlsym", first_glibc);
        memcpy(&next, &found, sizeof found);
    }
    if (strcmp(symbol, "cuGetProcAddress") == 0 || strcmp(symbol, "cuGetProcAddress_v2") == 0)
    {
        void* found = next(library, symbol);
        memcpy(&driver_lookup, &found, sizeof found);
        return found ? (void*)lookup : NULL;
    }
    return next(library, symbol);
}
