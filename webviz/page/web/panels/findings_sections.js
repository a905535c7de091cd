// Sections below the findings in their panel; features add to them.

/**
 * `trial` says in a sentence what is tried, "" for nothing: it stands above the findings.
 *
 * @typedef {() => {element?: Element, close?: () => unknown, trial?: () => string}} FindingsSection
 */

/** @type {FindingsSection[]} */
export const findingsSections = [];

/** @param {FindingsSection} make called when the panel is opened */
export const findingsSection = (make) => findingsSections.push(make);
