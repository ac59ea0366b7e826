/* The least that a test needs: checks that go on after a failure, and an exit status. */
#ifndef QUADREL_TESTS_CHECK_H
#define QUADREL_TESTS_CHECK_H

#include <stdio.h>

static int failures = 0;

#define CHECK(condition)                                                             \
    do {                                                                             \
        if (!(condition)) {                                                          \
            fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, #condition); \
            ++failures;                                                              \
        }                                                                            \
    } while (0)

/* Checks a status and, where it is another, shows what quadrel says. */
#define CHECK_STATUS(call, expected)                                                                  \
    do {                                                                                              \
        const int32_t found_ = (call);                                                                \
        if (found_ != (expected)) {                                                                   \
            fprintf(stderr, "%s:%d: %s is %s, not %s: %s\n", __FILE__, __LINE__, #call,               \
                    quadrel_status_name(found_), quadrel_status_name(expected), quadrel_last_error_message()); \
            ++failures;                                                                               \
        }                                                                                             \
    } while (0)

#define OK(call) CHECK_STATUS(call, QUADREL_OK)

#endif
