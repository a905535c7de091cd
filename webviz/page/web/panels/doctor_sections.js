// Sections of the panel "Doctor" below its findings; features add to them.

/** @typedef {() => {element: Element, close: () => unknown}} DoctorSection */

/** @type {DoctorSection[]} */
export const doctorSections = [];

/** @param {DoctorSection} make called when the panel is opened */
export const doctorSection = (make) => doctorSections.push(make);
