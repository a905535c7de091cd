// Sections of the panel "Doctor" below its findings; features add to them.

/**
 * `trial` says in a sentence what is tried, "" for nothing: it stands above the findings.
 *
 * @typedef {() => {element?: Element, close?: () => unknown, trial?: () => string}} DoctorSection
 */

/** @type {DoctorSection[]} */
export const doctorSections = [];

/** @param {DoctorSection} make called when the panel is opened */
export const doctorSection = (make) => doctorSections.push(make);
