/* Makes one call of the system that changes files fail, to be loaded before the C library
 * (LD_PRELOAD): the n-th of those that concern files below a folder, of one process.
 *
 * fault_arm(folder, n, error, all) begins to count; from the n-th call on (all) or for it alone,
 * calls fail with `error`; 0 kills the process there. `all` 2 lets calls pass that need no room. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

static char folder_[PATH_MAX];
static size_t length_;
static long left_, seen_;
static int error_, all_;
static pid_t process_;

void fault_arm(const char* folder, long n, int error, int all) {
  strncpy(folder_, folder, sizeof folder_ - 1);
  length_ = strlen(folder_);
  left_ = n;
  seen_ = 0;
  error_ = error;
  all_ = all;
  process_ = getpid();
}

long fault_seen(void) { return seen_; }

static int below(const char* path) { return !strncmp(path, folder_, length_); }

static int below_at(int at, const char* path) {
  char base[PATH_MAX + 32] = "", link[64];
  ssize_t n;
  if (path[0] == '/') return below(path);
  if (at == AT_FDCWD) return getcwd(base, PATH_MAX) && below(base);
  snprintf(link, sizeof link, "/proc/self/fd/%d", at);
  n = readlink(link, base, PATH_MAX);
  return n > 0 && (base[n] = 0, below(base));
}

static int below_fd(int fd) { return below_at(fd, ""); }

/* Whether the call is to fail. */
static int fails(int concerned, int needs_room) {
  int saved = errno;
  if (!process_ || process_ != getpid() || !concerned) return errno = saved, 0;
  if (all_ == 2 && !needs_room) return errno = saved, 0;
  ++seen_;
  if (left_ > 0 && --left_ == 0) {
    if (!error_) kill(getpid(), SIGKILL);
    if (all_) left_ = 1;
    return errno = error_, 1;
  }
  return errno = saved, 0;
}

#define NEXT(type, name, ...) ((type(*)(__VA_ARGS__))dlsym(RTLD_NEXT, #name))

static int opens(int at, const char* path, int flags) {
  return (flags & (O_CREAT | O_TRUNC)) && fails(below_at(at, path), 1);
}

#define OPEN(name)                                                       \
  int name(const char* path, int flags, ...) {                           \
    va_list rest;                                                        \
    va_start(rest, flags);                                               \
    int mode = va_arg(rest, int);                                        \
    va_end(rest);                                                        \
    if (opens(AT_FDCWD, path, flags)) return -1;                         \
    return NEXT(int, name, const char*, int, ...)(path, flags, mode);    \
  }
#define OPENAT(name)                                                     \
  int name(int at, const char* path, int flags, ...) {                   \
    va_list rest;                                                        \
    va_start(rest, flags);                                               \
    int mode = va_arg(rest, int);                                        \
    va_end(rest);                                                        \
    if (opens(at, path, flags)) return -1;                               \
    return NEXT(int, name, int, const char*, int, ...)(at, path, flags, mode); \
  }
OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)

ssize_t write(int fd, const void* data, size_t size) {
  if (fails(below_fd(fd), 1)) return -1;
  return NEXT(ssize_t, write, int, const void*, size_t)(fd, data, size);
}

ssize_t sendfile(int to, int from, off_t* at, size_t size) {
  if (fails(below_fd(to), 1)) return -1;
  return NEXT(ssize_t, sendfile, int, int, off_t*, size_t)(to, from, at, size);
}

ssize_t sendfile64(int to, int from, off64_t* at, size_t size) {
  if (fails(below_fd(to), 1)) return -1;
  return NEXT(ssize_t, sendfile64, int, int, off64_t*, size_t)(to, from, at, size);
}

int mkdir(const char* path, mode_t mode) {
  if (fails(below_at(AT_FDCWD, path), 1)) return -1;
  return NEXT(int, mkdir, const char*, mode_t)(path, mode);
}

int rename(const char* from, const char* to) {
  if (fails(below_at(AT_FDCWD, to), 0)) return -1;
  return NEXT(int, rename, const char*, const char*)(from, to);
}

int unlink(const char* path) {
  if (fails(below_at(AT_FDCWD, path), 0)) return -1;
  return NEXT(int, unlink, const char*)(path);
}

int unlinkat(int at, const char* path, int flags) {
  if (fails(below_at(at, path), 0)) return -1;
  return NEXT(int, unlinkat, int, const char*, int)(at, path, flags);
}

int rmdir(const char* path) {
  if (fails(below_at(AT_FDCWD, path), 0)) return -1;
  return NEXT(int, rmdir, const char*)(path);
}
