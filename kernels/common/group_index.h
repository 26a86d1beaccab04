// SPDX-License-Identifier: Apache-2.0
// Index of a work-group in a launch by Kernel::enqueue_groups (src/device/kernel_program.h).
#ifndef NAVVY_COMMON_GROUP_INDEX_H
#define NAVVY_COMMON_GROUP_INDEX_H

// Returns the index of the work-group, from 0. The host counts work-groups along the first axis or,
// where PoCL would keep a copy of the kernel for each number of them, along the third; the other
// axes have one.
static inline int group_index(void) { return (int)(get_group_id(0) + get_group_id(2)); }

#endif
