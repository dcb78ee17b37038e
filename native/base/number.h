/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Decimal numbers in text, whatever the process's locale says of decimal points (strtod follows it, and the program we
 * live in may have set it to a comma). */
#ifndef SWARF_BASE_NUMBER_H
#define SWARF_BASE_NUMBER_H

/** Read [+-] digits [. digits] [e [+-] digits] from `at` on, not beyond `end`: the longest such text, without blanks,
 *  to within two units in the last place. Returns where it ends; NULL, with `out` untouched, when there is no number or
 *  none that a double can hold. Any thread. */
const char *swarf_number_read(const char *at, const char *end, double *out);

#endif
