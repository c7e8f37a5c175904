/** Round feature of the moon: longitude east and latitude [°], radius [°], strength in [0, 1]. */
export type MoonFeature = readonly [
  longitude: number,
  latitude: number,
  radius: number,
  strength: number
]

/**
 * Maria: seas, lakes, bays and dark crater floors. Those that are not round are several discs.
 *
 * @see Gazetteer of Planetary Nomenclature, International Astronomical Union / USGS
 */
export const MARIA: readonly MoonFeature[] = [
  // Mare Imbrium, Sinus Iridum, Plato
  [-15.6, 34, 17.5, 0.9],
  [-31.5, 44.1, 4.2, 0.85],
  [-9.4, 51.6, 1.9, 1],
  // Mare Serenitatis, Lacus Somniorum, Lacus Mortis
  [17.5, 27.5, 11, 0.95],
  [30, 37, 4.5, 0.6],
  [27.3, 45, 2.5, 0.5],
  // Mare Tranquillitatis, Sinus Asperitatis
  [26.5, 9.5, 9.5, 1],
  [36, 7, 8.5, 1],
  [33, 15.5, 6.5, 0.95],
  [27.4, -4, 4.2, 0.85],
  // Mare Crisium, longer from west to east
  [57.2, 17, 6.9, 1],
  [61.2, 17, 6.9, 1],
  // Mare Fecunditatis
  [52, -3, 8.5, 0.9],
  [50, -13, 6, 0.85],
  // Mare Nectaris
  [35.5, -15.2, 5.4, 0.9],
  // Oceanus Procellarum, Sinus Roris
  [-56, 20, 12.5, 0.9],
  [-48, 6, 12.5, 0.9],
  [-43, -4, 9, 0.85],
  [-59, 33, 9.5, 0.9],
  [-61, 9, 9, 0.9],
  [-50, 44, 8, 0.85],
  [-57, 53, 5.5, 0.75],
  // Mare Insularum, Mare Cognitum, Mare Nubium, Mare Humorum, Palus Epidemiarum
  [-30, 8, 7.5, 0.75],
  [-23, -10, 6.5, 0.9],
  [-16.6, -20.5, 9.5, 0.85],
  [-10.5, -15, 4.5, 0.7],
  [-38.6, -24.4, 6.4, 0.95],
  [-28.2, -32, 3.6, 0.7],
  // Mare Vaporum, Sinus Medii, Sinus Aestuum
  [3.6, 13.3, 4, 0.85],
  [1.5, 2.2, 3.6, 0.75],
  [-8.8, 11, 4.2, 0.8],
  // Mare Frigoris
  [-38, 57, 3.8, 0.65],
  [-22, 59.5, 3.4, 0.65],
  [-5, 58.5, 3.2, 0.65],
  [11, 56.5, 3.2, 0.65],
  [25, 54, 3.4, 0.6],
  [37, 52, 3.4, 0.55],
  // Along the eastern limb: Undarum, Spumans, Marginis, Smythii, Humboldtianum, Australe
  [68.4, 7, 2.8, 0.6],
  [65.1, 1.1, 2.2, 0.6],
  [86.1, 13.3, 6, 0.65],
  [87.5, -1.3, 6, 0.75],
  [81.5, 56.8, 4.4, 0.7],
  [91, -39, 9, 0.5],
  // Grimaldi, Riccioli
  [-68.3, -5.4, 2.8, 1],
  [-74.6, -3, 1.6, 0.8]
]

/** Craters with bright rays or a bright halo; the radius is that of the rays. */
export const RAYS: readonly MoonFeature[] = [
  // Tycho, Copernicus, Kepler, Aristarchus
  [-11.4, -43.3, 42, 1],
  [-20.1, 9.6, 15, 0.75],
  [-38, 8.1, 10, 0.7],
  [-47.5, 23.7, 8, 0.95],
  // Proclus, Langrenus, Stevinus A, Byrgius A, Anaxagoras, Thales, Menelaus, Aristillus, Petavius B
  [46.8, 16.1, 9, 0.7],
  [61, -8.9, 9, 0.45],
  [51.6, -31.8, 11, 0.7],
  [-63.7, -24.5, 10, 0.7],
  [-10.1, 73.4, 14, 0.55],
  [50.3, 61.8, 12, 0.5],
  [16, 16.3, 4, 0.4],
  [1.2, 33.9, 6, 0.3],
  [57.1, -19.9, 8, 0.45]
]

/** Large craters; the strength is that of their slopes. */
export const CRATERS: readonly MoonFeature[] = [
  // Tycho, Copernicus, Kepler, Aristarchus, Clavius, Maginus, Longomontanus
  [-11.4, -43.3, 1.4, 1],
  [-20.1, 9.6, 1.55, 1],
  [-38, 8.1, 0.55, 1],
  [-47.5, 23.7, 0.7, 1],
  [-14.1, -58.8, 3.8, 0.7],
  [-6.3, -50.5, 2.6, 0.5],
  [-21.8, -49.6, 2.4, 0.6],
  // Ptolemaeus, Alphonsus, Arzachel, Albategnius, Hipparchus
  [-1.9, -9.3, 2.5, 0.6],
  [-2.8, -13.4, 1.9, 0.7],
  [-1.9, -18.2, 1.6, 0.9],
  [4, -11.2, 2.2, 0.6],
  [5.2, -5.1, 2.3, 0.4],
  // Theophilus, Cyrillus, Catharina, Petavius, Langrenus, Furnerius, Janssen
  [26.4, -11.4, 1.65, 1],
  [24.1, -13.2, 1.6, 0.7],
  [23.4, -18.1, 1.65, 0.6],
  [60.4, -25.1, 3, 0.8],
  [61, -8.9, 2.2, 0.9],
  [60.6, -36, 2.1, 0.6],
  [41.5, -45, 3.3, 0.4],
  // Plato, Archimedes, Aristoteles, Eudoxus, Posidonius, Cleomedes, Gassendi, Schickard, Eratosthenes
  [-9.4, 51.6, 1.7, 0.6],
  [-4, 29.7, 1.35, 0.6],
  [17.3, 50.2, 1.45, 0.9],
  [16.3, 44.3, 1.1, 0.9],
  [29.9, 31.9, 1.6, 0.5],
  [55.5, 27.7, 2.1, 0.6],
  [-39.9, -17.6, 1.85, 0.6],
  [-54.6, -44.5, 3.4, 0.4],
  [-11.3, 14.5, 0.95, 1]
]
