// Preloaded before the system's library: counts the calls that change files in one folder, and at
// the n-th one kills the process or reports an error. Armed and read by functions that the program
// calls through ctypes.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum { NOTHING, KILL_BEFORE, KILL_HALF_WAY, FAIL_ONCE, FAIL_FROM_NOW_ON };

static char folder[4096];
static volatile long calls, fault_at;
static volatile int mode, error_number;
static char last[32];

/// Count the calls for files in `path` from now on; at call number `at` do `what`.
void faults_arm(const char* path, long at, int what, int error) {
  strncpy(folder, path, sizeof(folder) - 1);
  calls = 0;
  fault_at = at;
  mode = what;
  error_number = error;
}
long faults_calls(void) { return calls; }
/// The name of the call at which the fault was.
const char* faults_last(void) { return last; }

static int is_path(const char* path) {
  char whole[8192];
  if (!folder[0] || !path) return 0;
  if (path[0] != '/') {
    if (!getcwd(whole, 4000)) return 0;
    strcat(whole, "/");
    strncat(whole, path, 4000);
    path = whole;
  }
  return strncmp(path, folder, strlen(folder)) == 0;
}
static int is_file(int fd) {
  char link[64], path[4096];
  if (!folder[0] || fd < 3) return 0;
  snprintf(link, sizeof(link), "/proc/self/fd/%d", fd);
  const ssize_t n = readlink(link, path, sizeof(path) - 1);
  if (n <= 0) return 0;
  path[n] = 0;
  return is_path(path);
}
static void die(void) {
  kill(getpid(), SIGKILL);
  for (;;) pause();
}
/// Whether the call is to fail; `half` tells whether it is to be made by half before the end.
static int fails(const char* name, int* half) {
  const long now = __sync_add_and_fetch(&calls, 1);
  if (half) *half = 0;
  if (now < fault_at || fault_at == 0 || (now > fault_at && mode != FAIL_FROM_NOW_ON)) return 0;
  if (now == fault_at) strncpy(last, name, sizeof(last) - 1);
  if (mode == KILL_BEFORE) die();
  if (mode == KILL_HALF_WAY) {
    if (!half) die();
    *half = 1;
    return 0;
  }
  return mode == FAIL_ONCE || mode == FAIL_FROM_NOW_ON;
}

#define REAL(name)               \
  static __typeof__(name)* real; \
  if (!real) real = (__typeof__(name)*)dlsym(RTLD_NEXT, #name)

ssize_t write(int fd, const void* data, size_t size) {
  REAL(write);
  int half;
  if (is_file(fd)) {
    if (fails("write", &half)) return errno = error_number, -1;
    if (half) real(fd, data, size / 2), die();
  }
  return real(fd, data, size);
}
ssize_t writev(int fd, const struct iovec* parts, int count) {
  REAL(writev);
  if (is_file(fd) && fails("writev", 0)) return errno = error_number, -1;
  return real(fd, parts, count);
}
#define PWRITE(name, offset_type)                                       \
  ssize_t name(int fd, const void* data, size_t size, offset_type at) { \
    REAL(name);                                                         \
    int half;                                                           \
    if (is_file(fd)) {                                                  \
      if (fails(#name, &half)) return errno = error_number, -1;         \
      if (half) real(fd, data, size / 2, at), die();                    \
    }                                                                   \
    return real(fd, data, size, at);                                    \
  }
PWRITE(pwrite, off_t)
PWRITE(pwrite64, off64_t)

#define CALL(name, parameters, arguments, concerned)                     \
  int name parameters {                                                  \
    REAL(name);                                                          \
    if ((concerned) && fails(#name, 0)) return errno = error_number, -1; \
    return real arguments;                                               \
  }
CALL(rename, (const char* a, const char* b), (a, b), is_path(a) || is_path(b))
CALL(renameat, (int x, const char* a, int y, const char* b), (x, a, y, b), is_path(a) || is_path(b))
CALL(link, (const char* a, const char* b), (a, b), is_path(a) || is_path(b))
CALL(unlink, (const char* a), (a), is_path(a))
CALL(unlinkat, (int x, const char* a, int f), (x, a, f), is_path(a))
CALL(mkdir, (const char* a, mode_t m), (a, m), is_path(a))
// No power cut is tried, so that nothing has to wait for the disk.
#define SYNC(name) \
  int name(int fd) { return is_file(fd) && fails(#name, 0) ? (errno = error_number, -1) : 0; }
SYNC(fsync)
SYNC(fdatasync)
CALL(ftruncate, (int fd, off_t n), (fd, n), is_file(fd))
CALL(ftruncate64, (int fd, off64_t n), (fd, n), is_file(fd))
CALL(truncate, (const char* a, off_t n), (a, n), is_path(a))
CALL(truncate64, (const char* a, off64_t n), (a, n), is_path(a))

#define FALLOCATE(name, offset_type)                                           \
  int name(int fd, offset_type at, offset_type size) {                         \
    REAL(name);                                                                \
    return is_file(fd) && fails(#name, 0) ? error_number : real(fd, at, size); \
  }
FALLOCATE(posix_fallocate, off_t)
FALLOCATE(posix_fallocate64, off64_t)

/// The file is closed even where an error is reported (Linux, close(2)).
int close(int fd) {
  REAL(close);
  const int concerned = is_file(fd) && (fcntl(fd, F_GETFL) & O_ACCMODE) != O_RDONLY;
  const int bad = concerned && fails("close", 0);
  const int done = real(fd);
  return bad ? (errno = error_number, -1) : done;
}

// Only those that may make a file or empty it.
#define OPEN(name)                                                         \
  int name(const char* path, int flags, ...) {                             \
    REAL(name);                                                            \
    va_list more;                                                          \
    va_start(more, flags);                                                 \
    const mode_t m = va_arg(more, mode_t);                                 \
    va_end(more);                                                          \
    if ((flags & (O_CREAT | O_TRUNC)) && is_path(path) && fails(#name, 0)) \
      return errno = error_number, -1;                                     \
    return real(path, flags, m);                                           \
  }
OPEN(open)
OPEN(open64)
