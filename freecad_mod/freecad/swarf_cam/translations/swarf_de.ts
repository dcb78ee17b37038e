<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
    <context>
        <name>App::Property</name>
        <message>
            <source>Colours of the triangles, by operation</source>
            <translation>Farben der Dreiecke, nach Bearbeitung</translation>
        </message>
        <message>
            <source>Edge of a voxel: the finer, the more exact, the slower</source>
            <translation>Kante eines Voxels: je feiner, desto genauer und langsamer</translation>
        </message>
        <message>
            <source>Findings that are accepted, with their reasons</source>
            <translation>Befunde, die hingenommen werden, mit Begründung</translation>
        </message>
        <message>
            <source>From the tool's tip to the holder's lower face</source>
            <translation>Von der Werkzeugspitze bis zur Unterseite des Halters</translation>
        </message>
        <message>
            <source>Hash of the inputs of the results</source>
            <translation>Prüfsumme der Eingaben der Ergebnisse</translation>
        </message>
        <message>
            <source>How long the simulation took</source>
            <translation>Wie lange die Simulation dauerte</translation>
        </message>
        <message>
            <source>How that result lies here: from its job's coordinates to these</source>
            <translation>Wie dieses Ergebnis hier liegt: von den Koordinaten seines Auftrags zu diesen</translation>
        </message>
        <message>
            <source>Material left outside the model</source>
            <translation>Material, das außerhalb des Modells stehen blieb</translation>
        </message>
        <message>
            <source>Material missing inside the model</source>
            <translation>Material, das im Modell fehlt</translation>
        </message>
        <message>
            <source>Names of the operations that were simulated</source>
            <translation>Namen der simulierten Operationen</translation>
        </message>
        <message>
            <source>Number of findings of class error</source>
            <translation>Anzahl der Befunde der Klasse Fehler</translation>
        </message>
        <message>
            <source>Number of moves</source>
            <translation>Anzahl der Bewegungen</translation>
        </message>
        <message>
            <source>Simulation whose result is the stock; none: the job's own stock</source>
            <translation>Simulation, deren Ergebnis das Rohteil ist; keine: das eigene Rohteil des Auftrags</translation>
        </message>
        <message>
            <source>The job that is simulated</source>
            <translation>Der Auftrag, der simuliert wird</translation>
        </message>
        <message>
            <source>Version of these properties</source>
            <translation>Version dieser Eigenschaften</translation>
        </message>
        <message>
            <source>Volume of the stock after</source>
            <translation>Volumen des Rohteils danach</translation>
        </message>
        <message>
            <source>Volume of the stock before</source>
            <translation>Volumen des Rohteils davor</translation>
        </message>
        <message>
            <source>Volume removed by all operations</source>
            <translation>Von allen Operationen abgetragenes Volumen</translation>
        </message>
        <message>
            <source>Volume removed by each operation, mm^3</source>
            <translation>Von jeder Operation abgetragenes Volumen, mm^3</translation>
        </message>
        <message>
            <source>What holds the stock: nothing may touch it</source>
            <translation>Was das Rohteil hält: nichts darf es berühren</translation>
        </message>
        <message>
            <source>What holds the tool, e.g. SK40-ER32</source>
            <translation>Was das Werkzeug hält, z. B. SK40-ER32</translation>
        </message>
        <message>
            <source>What is left of the stock, an OpenVDB level set</source>
            <translation>Was vom Rohteil übrig ist, ein OpenVDB-Level-Set</translation>
        </message>
        <message>
            <source>What the simulation noticed</source>
            <translation>Was der Simulation auffiel</translation>
        </message>
        <message>
            <source>Whether the job's model could be compared</source>
            <translation>Ob das Modell des Auftrags verglichen werden konnte</translation>
        </message>
        <message>
            <source>Whether the results belong to the job as it is now</source>
            <translation>Ob die Ergebnisse zum Auftrag gehören, wie er jetzt ist</translation>
        </message>
    </context>
    <context>
        <name>Swarf</name>
        <message>
            <source>, about {0} s to cut once</source>
            <translation>, etwa {0} s für einmal Zerspanen</translation>
        </message>
        <message>
            <source>98 % lie within</source>
            <translation>98 % liegen in</translation>
        </message>
        <message>
            <source>; too many for flat facets: a shape only if all its faces are planes, cylinders, cones, spheres and tori</source>
            <translation>; zu viele für ebene Facetten: ein Körper nur, wenn alle Flächen Ebenen, Zylinder, Kegel, Kugeln und Tori sind</translation>
        </message>
        <message>
            <source>A holder of the library, or form:r/z:r/z... from its lower face up, in mm</source>
            <translation>Ein Halter der Sammlung, oder form:r/z:r/z... von seiner Unterseite aufwärts, in mm</translation>
        </message>
        <message>
            <source>Accept</source>
            <translation>Annehmen</translation>
        </message>
        <message>
            <source>Accept a finding</source>
            <translation>Einen Befund annehmen</translation>
        </message>
        <message>
            <source>Accept a finding no more</source>
            <translation>Einen Befund nicht mehr annehmen</translation>
        </message>
        <message>
            <source>Accept the chosen finding, with a reason; or no more</source>
            <translation>Den gewählten Befund mit einem Grund annehmen; oder nicht mehr</translation>
        </message>
        <message>
            <source>Accepted because</source>
            <translation>Angenommen, weil</translation>
        </message>
        <message>
            <source>Accepted because: {0}</source>
            <translation>Angenommen, weil: {0}</translation>
        </message>
        <message>
            <source>Accuracy</source>
            <translation>Voxel</translation>
        </message>
        <message>
            <source>Add fixtures</source>
            <translation>Spannmittel hinzufügen</translation>
        </message>
        <message>
            <source>Add selected</source>
            <translation>Gewählte dazu</translation>
        </message>
        <message>
            <source>Again</source>
            <translation>Noch einmal</translation>
        </message>
        <message>
            <source>All kinds</source>
            <translation>Alle Arten</translation>
        </message>
        <message>
            <source>Allowance</source>
            <translation>Aufmaß</translation>
        </message>
        <message>
            <source>Area</source>
            <translation>Fläche</translation>
        </message>
        <message>
            <source>Area of the surface by its deviation</source>
            <translation>Fläche nach ihrer Abweichung</translation>
        </message>
        <message>
            <source>As those of threads and narrow grooves; takes longer</source>
            <translation>Wie die von Gewinden und schmalen Nuten; dauert länger</translation>
        </message>
        <message>
            <source>Axis</source>
            <translation>Achse</translation>
        </message>
        <message>
            <source>Axis that the plane is across</source>
            <translation>Achse, quer zu der die Ebene liegt</translation>
        </message>
        <message>
            <source>Axis that the section is across</source>
            <translation>Achse, quer zu der geschnitten wird</translation>
        </message>
        <message>
            <source>BOTTOM</source>
            <translation>UNTEN</translation>
        </message>
        <message>
            <source>Below the top</source>
            <translation>Unter der Oberkante</translation>
        </message>
        <message>
            <source>Both</source>
            <translation>Beides</translation>
        </message>
        <message>
            <source>Box from</source>
            <translation>Quader von</translation>
        </message>
        <message>
            <source>Box to</source>
            <translation>Quader bis</translation>
        </message>
        <message>
            <source>By age</source>
            <translation>Nach Alter</translation>
        </message>
        <message>
            <source>By feed</source>
            <translation>Nach Vorschub</translation>
        </message>
        <message>
            <source>By operation</source>
            <translation>Nach Operation</translation>
        </message>
        <message>
            <source>By tool</source>
            <translation>Nach Werkzeug</translation>
        </message>
        <message>
            <source>Cancel</source>
            <translation>Abbrechen</translation>
        </message>
        <message>
            <source>Cancelled.</source>
            <translation>Abgebrochen.</translation>
        </message>
        <message>
            <source>Cancelled; nothing was changed.</source>
            <translation>Abgebrochen; nichts wurde geändert.</translation>
        </message>
        <message>
            <source>Cancelling ...</source>
            <translation>Wird abgebrochen ...</translation>
        </message>
        <message>
            <source>Centre of mass</source>
            <translation>Schwerpunkt</translation>
        </message>
        <message>
            <source>Check</source>
            <translation>Prüfen</translation>
        </message>
        <message>
            <source>Check again</source>
            <translation>Noch einmal prüfen</translation>
        </message>
        <message>
            <source>Check the job when it is opened</source>
            <translation>Den Auftrag beim Öffnen prüfen</translation>
        </message>
        <message>
            <source>Checked</source>
            <translation>Geprüft</translation>
        </message>
        <message>
            <source>Checked, over an allowance of {0} mm</source>
            <translation>Geprüft, über ein Aufmaß von {0} mm hinaus</translation>
        </message>
        <message>
            <source>Checked, without a model to compare with</source>
            <translation>Geprüft, ohne Modell zum Vergleichen</translation>
        </message>
        <message>
            <source>Checked: nothing was found</source>
            <translation>Geprüft: nichts gefunden</translation>
        </message>
        <message>
            <source>Checking ...</source>
            <translation>Wird geprüft ...</translation>
        </message>
        <message>
            <source>Choose a holder</source>
            <translation>Einen Halter wählen</translation>
        </message>
        <message>
            <source>Clearance of holders</source>
            <translation>Abstand der Halter</translation>
        </message>
        <message>
            <source>Click on the stock to learn which line cut it.</source>
            <translation>Ein Klick auf das Rohteil zeigt, welche Zeile dort geschnitten hat.</translation>
        </message>
        <message>
            <source>Click: go to the move and the place</source>
            <translation>Klick: zur Bewegung und zur Stelle gehen</translation>
        </message>
        <message>
            <source>Click: go to the operation. The box shows its path in the 3D view.</source>
            <translation>Klick: zur Operation gehen. Das Kästchen zeigt ihre Bahn in der 3D-Ansicht.</translation>
        </message>
        <message>
            <source>Close</source>
            <translation>Schließen</translation>
        </message>
        <message>
            <source>Colours</source>
            <translation>Farben</translation>
        </message>
        <message>
            <source>Copy the picture</source>
            <translation>Bild kopieren</translation>
        </message>
        <message>
            <source>Cut at</source>
            <translation>Geschnitten um</translation>
        </message>
        <message>
            <source>Cut the stock open</source>
            <translation>Das Werkstück aufschneiden</translation>
        </message>
        <message>
            <source>Cut too deep</source>
            <translation>Zu tief geschnitten</translation>
        </message>
        <message>
            <source>Cutting '{0}' once ...</source>
            <translation>„{0}“ wird einmal zerspant ...</translation>
        </message>
        <message>
            <source>Cutting and comparing for the document ...</source>
            <translation>Zerspanen und Vergleichen für das Dokument ...</translation>
        </message>
        <message>
            <source>Darken corners when the view is at rest</source>
            <translation>Ecken abdunkeln, wenn die Ansicht ruht</translation>
        </message>
        <message>
            <source>Deeper than the flutes</source>
            <translation>Tiefer als die Schneiden</translation>
        </message>
        <message>
            <source>Deviation</source>
            <translation>Abweichung</translation>
        </message>
        <message>
            <source>Deviation from the model that is well</source>
            <translation>Erlaubte Abweichung vom Modell</translation>
        </message>
        <message>
            <source>Drawing ...</source>
            <translation>Wird gezeichnet ...</translation>
        </message>
        <message>
            <source>Drawing the animation ...</source>
            <translation>Die Animation wird gezeichnet ...</translation>
        </message>
        <message>
            <source>Error</source>
            <translation>Fehler</translation>
        </message>
        <message>
            <source>Export stock</source>
            <translation>Rohteil exportieren</translation>
        </message>
        <message>
            <source>FAILED</source>
            <translation>NICHT BESTANDEN</translation>
        </message>
        <message>
            <source>FRONT</source>
            <translation>VORNE</translation>
        </message>
        <message>
            <source>Feed</source>
            <translation>Vorschub</translation>
        </message>
        <message>
            <source>Finding</source>
            <translation>Befund</translation>
        </message>
        <message>
            <source>Findings</source>
            <translation>Befunde</translation>
        </message>
        <message>
            <source>Fixtures</source>
            <translation>Spannmittel</translation>
        </message>
        <message>
            <source>Flat triangles between points of a curved face change its volume: shift the points by a fifth of the error at most, so that they do not. What is thinner than a voxel is in no mesh, and is not made up for</source>
            <translation>Ebene Dreiecke zwischen Punkten einer gekrümmten Fläche ändern deren Volumen: die Punkte um höchstens ein Fünftel des Fehlers verschieben, damit sie es nicht tun. Was dünner als ein Voxel ist, ist in keinem Netz und wird nicht ausgeglichen</translation>
        </message>
        <message>
            <source>Folder for the frames of the animation</source>
            <translation>Ordner für die Bilder der Animation</translation>
        </message>
        <message>
            <source>Format</source>
            <translation>Format</translation>
        </message>
        <message>
            <source>From the tool's tip to the holder</source>
            <translation>Von der Werkzeugspitze bis zum Halter</translation>
        </message>
        <message>
            <source>Gouges</source>
            <translation>Zu tief</translation>
        </message>
        <message>
            <source>Holder</source>
            <translation>Halter</translation>
        </message>
        <message>
            <source>Holes through it</source>
            <translation>Löcher</translation>
        </message>
        <message>
            <source>Hollow {0}</source>
            <translation>Hohlraum {0}</translation>
        </message>
        <message>
            <source>How fast (Up, Down)</source>
            <translation>Wie schnell (Auf, Ab)</translation>
        </message>
        <message>
            <source>How fine a job is cut at first: more is sharper and slower</source>
            <translation>Wie fein ein Auftrag anfangs zerspant wird: mehr ist schärfer und langsamer</translation>
        </message>
        <message>
            <source>Idle acceptances</source>
            <translation>Annahmen ohne Befund</translation>
        </message>
        <message>
            <source>In the document: {0}</source>
            <translation>Im Dokument: {0}</translation>
        </message>
        <message>
            <source>Inertia</source>
            <translation>Trägheit</translation>
        </message>
        <message>
            <source>Inertia is about the centre of mass and of density 1: times kg/mm³ it is kg mm²</source>
            <translation>Die Trägheit ist die um den Schwerpunkt bei der Dichte 1: mal kg/mm³ ist sie kg mm²</translation>
        </message>
        <message>
            <source>It lies</source>
            <translation>Es liegt</translation>
        </message>
        <message>
            <source>Job</source>
            <translation>Auftrag</translation>
        </message>
        <message>
            <source>Judging ...</source>
            <translation>Wird beurteilt ...</translation>
        </message>
        <message>
            <source>LEFT</source>
            <translation>LINKS</translation>
        </message>
        <message>
            <source>Least and greatest</source>
            <translation>Kleinste und größte</translation>
        </message>
        <message>
            <source>Line</source>
            <translation>Zeile</translation>
        </message>
        <message>
            <source>Live milling</source>
            <translation>Fräsen, live</translation>
        </message>
        <message>
            <source>Loads</source>
            <translation>Lasten</translation>
        </message>
        <message>
            <source>Look from the corner (0); 1 to 6: the sides</source>
            <translation>Von der Ecke ansehen (0); 1 bis 6: die Seiten</translation>
        </message>
        <message>
            <source>Loose pieces</source>
            <translation>Lose Stücke</translation>
        </message>
        <message>
            <source>Making the shape ...</source>
            <translation>Der Körper wird erstellt ...</translation>
        </message>
        <message>
            <source>Material</source>
            <translation>Material</translation>
        </message>
        <message>
            <source>Material left</source>
            <translation>Material übrig</translation>
        </message>
        <message>
            <source>Mean, root mean square</source>
            <translation>Mittel, quadratisches Mittel</translation>
        </message>
        <message>
            <source>Measures</source>
            <translation>Maße</translation>
        </message>
        <message>
            <source>Measures of the stock</source>
            <translation>Maße des Rohteils</translation>
        </message>
        <message>
            <source>Milling simulation</source>
            <translation>Frässimulation</translation>
        </message>
        <message>
            <source>Milling, live</source>
            <translation>Fräsen, live</translation>
        </message>
        <message>
            <source>Model</source>
            <translation>Modell</translation>
        </message>
        <message>
            <source>Near misses</source>
            <translation>Beinahe berührt</translation>
        </message>
        <message>
            <source>Not enough memory: {0} Choose larger voxels on the page Accuracy.</source>
            <translation>Zu wenig Speicher: {0} Wählen Sie auf der Seite Voxel größere.</translation>
        </message>
        <message>
            <source>Not reached</source>
            <translation>Nicht erreicht</translation>
        </message>
        <message>
            <source>Not simulated</source>
            <translation>Nicht simuliert</translation>
        </message>
        <message>
            <source>Note</source>
            <translation>Hinweis</translation>
        </message>
        <message>
            <source>One line back (Left)</source>
            <translation>Eine Zeile zurück (Links)</translation>
        </message>
        <message>
            <source>One line forward (Right)</source>
            <translation>Eine Zeile vor (Rechts)</translation>
        </message>
        <message>
            <source>One move back (Alt+Left)</source>
            <translation>Eine Bewegung zurück (Alt+Links)</translation>
        </message>
        <message>
            <source>One move forward (Alt+Right)</source>
            <translation>Eine Bewegung vor (Alt+Rechts)</translation>
        </message>
        <message>
            <source>Operation</source>
            <translation>Operation</translation>
        </message>
        <message>
            <source>Operations</source>
            <translation>Operationen</translation>
        </message>
        <message>
            <source>Part {0}</source>
            <translation>Teil {0}</translation>
        </message>
        <message>
            <source>Perspective</source>
            <translation>Perspektive</translation>
        </message>
        <message>
            <source>Perspective (P)</source>
            <translation>Perspektive (P)</translation>
        </message>
        <message>
            <source>Picture of the stock</source>
            <translation>Bild des Rohteils</translation>
        </message>
        <message>
            <source>Picture or animation</source>
            <translation>Bild oder Animation</translation>
        </message>
        <message>
            <source>Piece {0}</source>
            <translation>Stück {0}</translation>
        </message>
        <message>
            <source>Place of the plane on the axis</source>
            <translation>Lage der Ebene auf der Achse</translation>
        </message>
        <message>
            <source>Place of the section</source>
            <translation>Lage des Schnitts</translation>
        </message>
        <message>
            <source>Play as soon as the job is read</source>
            <translation>Abspielen, sobald der Auftrag gelesen ist</translation>
        </message>
        <message>
            <source>Play or pause (Space)</source>
            <translation>Abspielen oder anhalten (Leertaste)</translation>
        </message>
        <message>
            <source>Plunges</source>
            <translation>Eintauchen</translation>
        </message>
        <message>
            <source>Point</source>
            <translation>Punkt</translation>
        </message>
        <message>
            <source>Position</source>
            <translation>Lage</translation>
        </message>
        <message>
            <source>Principal axis</source>
            <translation>Hauptachse</translation>
        </message>
        <message>
            <source>Principal moment</source>
            <translation>Hauptträgheitsmoment</translation>
        </message>
        <message>
            <source>Program</source>
            <translation>Programm</translation>
        </message>
        <message>
            <source>Put into a spreadsheet</source>
            <translation>In eine Tabelle übernehmen</translation>
        </message>
        <message>
            <source>Put the result into the document</source>
            <translation>Ergebnis in das Dokument legen</translation>
        </message>
        <message>
            <source>REAR</source>
            <translation>HINTEN</translation>
        </message>
        <message>
            <source>RIGHT</source>
            <translation>RECHTS</translation>
        </message>
        <message>
            <source>Rapids in material</source>
            <translation>Eilgang im Material</translation>
        </message>
        <message>
            <source>Read the job again</source>
            <translation>Auftrag neu lesen</translation>
        </message>
        <message>
            <source>Reading '{0}' ...</source>
            <translation>'{0}' wird gelesen ...</translation>
        </message>
        <message>
            <source>Remove</source>
            <translation>Entfernen</translation>
        </message>
        <message>
            <source>Remove a fixture</source>
            <translation>Ein Spannmittel entfernen</translation>
        </message>
        <message>
            <source>Removed</source>
            <translation>Abgetragen</translation>
        </message>
        <message>
            <source>Result</source>
            <translation>Ergebnis</translation>
        </message>
        <message>
            <source>Save an animation ...</source>
            <translation>Animation speichern ...</translation>
        </message>
        <message>
            <source>Save the picture</source>
            <translation>Bild speichern</translation>
        </message>
        <message>
            <source>Save the picture ...</source>
            <translation>Bild speichern ...</translation>
        </message>
        <message>
            <source>Section</source>
            <translation>Schnitt</translation>
        </message>
        <message>
            <source>Section of the stock</source>
            <translation>Schnitt durch das Rohteil</translation>
        </message>
        <message>
            <source>Select the solids or meshes that hold the stock in FreeCAD's tree or 3D view first.</source>
            <translation>Zuerst die Körper oder Netze, die das Rohteil halten, in FreeCADs Baum oder 3D-Ansicht wählen.</translation>
        </message>
        <message>
            <source>Set-up</source>
            <translation>Aufspannung</translation>
        </message>
        <message>
            <source>Shadows when the view is at rest</source>
            <translation>Schatten, wenn die Ansicht ruht</translation>
        </message>
        <message>
            <source>Shank</source>
            <translation>Schaft</translation>
        </message>
        <message>
            <source>Show errors</source>
            <translation>Fehler zeigen</translation>
        </message>
        <message>
            <source>Show notes and what is accepted</source>
            <translation>Hinweise und Angenommenes zeigen</translation>
        </message>
        <message>
            <source>Show one kind of findings</source>
            <translation>Eine Art von Befunden zeigen</translation>
        </message>
        <message>
            <source>Show the cutter</source>
            <translation>Werkzeug zeigen</translation>
        </message>
        <message>
            <source>Show the origin and the outline of the stock</source>
            <translation>Ursprung und Umriss des Rohteils zeigen</translation>
        </message>
        <message>
            <source>Show the stock, the model that it should become, or one over the other</source>
            <translation>Das Rohteil zeigen, das Modell, das es werden soll, oder beide übereinander</translation>
        </message>
        <message>
            <source>Show the tool's path</source>
            <translation>Werkzeugbahn zeigen</translation>
        </message>
        <message>
            <source>Show the whole stock (F)</source>
            <translation>Ganzes Rohteil zeigen (F)</translation>
        </message>
        <message>
            <source>Show warnings</source>
            <translation>Warnungen zeigen</translation>
        </message>
        <message>
            <source>Simulate with this voxel size</source>
            <translation>Mit dieser Voxelgröße simulieren</translation>
        </message>
        <message>
            <source>Simulation</source>
            <translation>Simulation</translation>
        </message>
        <message>
            <source>Size</source>
            <translation>Größe</translation>
        </message>
        <message>
            <source>Slope</source>
            <translation>Neigung</translation>
        </message>
        <message>
            <source>Solids and meshes that are selected in FreeCAD hold the stock</source>
            <translation>Körper und Netze, die in FreeCAD gewählt sind, halten das Rohteil</translation>
        </message>
        <message>
            <source>Speed</source>
            <translation>Geschwindigkeit</translation>
        </message>
        <message>
            <source>Spindle</source>
            <translation>Spindel</translation>
        </message>
        <message>
            <source>Split the stock</source>
            <translation>Rohteil teilen</translation>
        </message>
        <message>
            <source>Starts in material</source>
            <translation>Beginn im Material</translation>
        </message>
        <message>
            <source>Stickout</source>
            <translation>Auskragung</translation>
        </message>
        <message>
            <source>Stock</source>
            <translation>Rohteil</translation>
        </message>
        <message>
            <source>Stock {0} cm³, removed {1} cm³, left {2} cm³</source>
            <translation>Rohteil {0} cm³, abgetragen {1} cm³, übrig {2} cm³</translation>
        </message>
        <message>
            <source>Stop at every operation</source>
            <translation>Bei jeder Operation anhalten</translation>
        </message>
        <message>
            <source>Stop at findings</source>
            <translation>Bei Befunden anhalten</translation>
        </message>
        <message>
            <source>Stop at the first error</source>
            <translation>Beim ersten Fehler anhalten</translation>
        </message>
        <message>
            <source>Stop at tool changes</source>
            <translation>Bei Werkzeugwechseln anhalten</translation>
        </message>
        <message>
            <source>Stop checking at the first error</source>
            <translation>Beim ersten Fehler aufhören zu prüfen</translation>
        </message>
        <message>
            <source>Stopped at the first error: the rest was not looked at</source>
            <translation>Beim ersten Fehler angehalten: der Rest wurde nicht angesehen</translation>
        </message>
        <message>
            <source>Swarf: close the open task first
</source>
            <translation>Swarf: schließen Sie zuerst die offene Aufgabe
</translation>
        </message>
        <message>
            <source>Swarf: in the document: {0}
</source>
            <translation>Swarf: im Dokument: {0}
</translation>
        </message>
        <message>
            <source>Swarf: the shape has {0} faces as they were cut: planes, cylinders, cones, spheres, tori
</source>
            <translation>Swarf: der Körper hat {0} Flächen, wie sie geschnitten wurden: Ebenen, Zylinder, Kegel, Kugeln, Tori
</translation>
        </message>
        <message>
            <source>Swarf: the shape is made of flat facets: {0}
</source>
            <translation>Swarf: der Körper besteht aus ebenen Facetten: {0}
</translation>
        </message>
        <message>
            <source>Swarf: the shape is made of flat facets; {0:.1f} % of its surface is planes, cylinders, cones, spheres and tori. Not all of it: {1}
</source>
            <translation>Swarf: der Körper besteht aus ebenen Facetten; {0:.1f} % seiner Oberfläche sind Ebenen, Zylinder, Kegel, Kugeln und Tori. Nicht alles: {1}
</translation>
        </message>
        <message>
            <source>Swarf: the simulation was deleted; its panel is closed
</source>
            <translation>Swarf: Die Simulation wurde gelöscht; ihre Aufgabe ist geschlossen
</translation>
        </message>
        <message>
            <source>Swarf: written: {0}, {1}
</source>
            <translation>Swarf: geschrieben: {0}, {1}
</translation>
        </message>
        <message>
            <source>Swarf: {0}: {1} mm^3 removed in {2} s
</source>
            <translation>Swarf: {0}: {1} mm^3 in {2} s abgetragen
</translation>
        </message>
        <message>
            <source>TOP</source>
            <translation>OBEN</translation>
        </message>
        <message>
            <source>Take the other side away</source>
            <translation>Die andere Seite wegnehmen</translation>
        </message>
        <message>
            <source>The document was closed.</source>
            <translation>Das Dokument wurde geschlossen.</translation>
        </message>
        <message>
            <source>The job cannot be read: {0}</source>
            <translation>Der Job kann nicht gelesen werden: {0}</translation>
        </message>
        <message>
            <source>The job is gone: its result cannot be kept.</source>
            <translation>Den Auftrag gibt es nicht mehr: sein Ergebnis kann nicht behalten werden.</translation>
        </message>
        <message>
            <source>The job is gone: nothing can be kept in it.</source>
            <translation>Der Job ist fort: in ihm kann nichts behalten werden.</translation>
        </message>
        <message>
            <source>The job is gone: select another one and start again.</source>
            <translation>Den Auftrag gibt es nicht mehr: wählen Sie einen anderen und beginnen Sie neu.</translation>
        </message>
        <message>
            <source>The job was changed. What you see is how it was.</source>
            <translation>Der Auftrag wurde geändert. Sie sehen, wie er war.</translation>
        </message>
        <message>
            <source>The job was deleted meanwhile; its simulation is discarded.</source>
            <translation>Der Auftrag wurde inzwischen gelöscht; seine Simulation wird verworfen.</translation>
        </message>
        <message>
            <source>The job was deleted while it was being read.</source>
            <translation>Der Auftrag wurde gelöscht, während er gelesen wurde.</translation>
        </message>
        <message>
            <source>The job was deleted. What you see is how it was; it can still be played.</source>
            <translation>Der Auftrag wurde gelöscht. Sie sehen, wie er war; er kann noch abgespielt werden.</translation>
        </message>
        <message>
            <source>The most triangles that the mesh may have: it is made with the least error that they suffice for; where that would be more than the error above, no file is written</source>
            <translation>So viele Dreiecke darf das Netz höchstens haben: es entsteht mit dem kleinsten Fehler, für den sie reichen; wäre er größer als der Fehler oben, wird keine Datei geschrieben</translation>
        </message>
        <message>
            <source>The result has not been held against a model yet.</source>
            <translation>Das Ergebnis wurde noch nicht mit einem Modell verglichen.</translation>
        </message>
        <message>
            <source>The stock as it was: nothing was cut here yet.</source>
            <translation>Das Rohteil, wie es war: hier wurde noch nichts geschnitten.</translation>
        </message>
        <message>
            <source>The stock changed meanwhile; nothing was split.</source>
            <translation>Das Rohteil hat sich inzwischen geändert; es wurde nichts geteilt.</translation>
        </message>
        <message>
            <source>The stock lies between {0} and {1} mm</source>
            <translation>Das Rohteil liegt zwischen {0} und {1} mm</translation>
        </message>
        <message>
            <source>The tool controller is gone.</source>
            <translation>Die Werkzeugsteuerung ist fort.</translation>
        </message>
        <message>
            <source>Thinnest at</source>
            <translation>Am dünnsten bei</translation>
        </message>
        <message>
            <source>Thinnest wall</source>
            <translation>Dünnste Wand</translation>
        </message>
        <message>
            <source>Time</source>
            <translation>Zeit</translation>
        </message>
        <message>
            <source>Time at the programmed feeds, of the whole program's</source>
            <translation>Zeit mit den programmierten Vorschüben, von der des ganzen Programms</translation>
        </message>
        <message>
            <source>Time line</source>
            <translation>Zeitleiste</translation>
        </message>
        <message>
            <source>To the next operation (Ctrl+Right)</source>
            <translation>Zur nächsten Operation (Strg+Rechts)</translation>
        </message>
        <message>
            <source>To the start of the operation (Ctrl+Left)</source>
            <translation>Zum Anfang der Operation (Strg+Links)</translation>
        </message>
        <message>
            <source>Too much left</source>
            <translation>Zu viel übrig</translation>
        </message>
        <message>
            <source>Tool</source>
            <translation>Werkzeug</translation>
        </message>
        <message>
            <source>Travel</source>
            <translation>Verfahrweg</translation>
        </message>
        <message>
            <source>Triangles</source>
            <translation>Dreiecke</translation>
        </message>
        <message>
            <source>Volume</source>
            <translation>Volumen</translation>
        </message>
        <message>
            <source>Voxel size</source>
            <translation>Voxelgröße</translation>
        </message>
        <message>
            <source>Voxels along the stock's longest edge</source>
            <translation>Voxel entlang der längsten Kante des Rohteils</translation>
        </message>
        <message>
            <source>Warn where a holder comes nearer to the stock than this</source>
            <translation>Warnen, wo ein Halter dem Rohteil näher kommt als dies</translation>
        </message>
        <message>
            <source>Warning</source>
            <translation>Warnung</translation>
        </message>
        <message>
            <source>What hangs together becomes a mesh, not all on one side of the plane</source>
            <translation>Was zusammenhängt, wird ein Netz, nicht alles auf einer Seite der Ebene</translation>
        </message>
        <message>
            <source>What holds the stock: nothing may touch it</source>
            <translation>Was das Rohteil hält: nichts darf es berühren</translation>
        </message>
        <message>
            <source>What is meant to be left on the model: it counts as no deviation</source>
            <translation>Was auf dem Modell stehen bleiben soll: es zählt nicht als Abweichung</translation>
        </message>
        <message>
            <source>What is measured: all of it, or a shell that hangs together</source>
            <translation>Was gemessen wird: alles, oder eine Schale, die zusammenhängt</translation>
        </message>
        <message>
            <source>What the colours of the stock show</source>
            <translation>Was die Farben des Rohteils zeigen</translation>
        </message>
        <message>
            <source>Where to stop by itself</source>
            <translation>Wo von selbst angehalten wird</translation>
        </message>
        <message>
            <source>Whole</source>
            <translation>Ganzes</translation>
        </message>
        <message>
            <source>Within the tolerance</source>
            <translation>In der Toleranz</translation>
        </message>
        <message>
            <source>Written: {0}</source>
            <translation>Geschrieben: {0}</translation>
        </message>
        <message>
            <source>about {0} triangles, {1}</source>
            <translation>etwa {0} Dreiecke, {1}</translation>
        </message>
        <message>
            <source>any number</source>
            <translation>beliebig viele</translation>
        </message>
        <message>
            <source>as before</source>
            <translation>wie bisher</translation>
        </message>
        <message>
            <source>as the model of the job</source>
            <translation>wie das Modell des Auftrags</translation>
        </message>
        <message>
            <source>at most {0} triangles, {1}</source>
            <translation>höchstens {0} Dreiecke, {1}</translation>
        </message>
        <message>
            <source>by deviation from the model</source>
            <translation>nach Abweichung vom Modell</translation>
        </message>
        <message>
            <source>by operation</source>
            <translation>nach Bearbeitung</translation>
        </message>
        <message>
            <source>by wall thickness</source>
            <translation>nach Wandstärke</translation>
        </message>
        <message>
            <source>each piece on its own</source>
            <translation>jedes Stück für sich</translation>
        </message>
        <message>
            <source>error</source>
            <translation>Fehler</translation>
        </message>
        <message>
            <source>faces as they were cut, exactly; where that cannot be, flat facets as asked for above: {0}</source>
            <translation>Flächen genau so, wie sie gefräst wurden; wo das nicht geht, ebene Facetten nach den Angaben oben: {0}</translation>
        </message>
        <message>
            <source>follow edges closer than a voxel</source>
            <translation>Kanten folgen, die näher als ein Voxel liegen</translation>
        </message>
        <message>
            <source>keep the volume</source>
            <translation>das Volumen erhalten</translation>
        </message>
        <message>
            <source>leave loose pieces out</source>
            <translation>lose Stücke weglassen</translation>
        </message>
        <message>
            <source>max</source>
            <translation>max.</translation>
        </message>
        <message>
            <source>mm over {0}</source>
            <translation>mm über {0}</translation>
        </message>
        <message>
            <source>none</source>
            <translation>keine</translation>
        </message>
        <message>
            <source>note</source>
            <translation>Hinweis</translation>
        </message>
        <message>
            <source>passed</source>
            <translation>bestanden</translation>
        </message>
        <message>
            <source>real time</source>
            <translation>Echtzeit</translation>
        </message>
        <message>
            <source>the job's own</source>
            <translation>das des Auftrags</translation>
        </message>
        <message>
            <source>the reason, kept in the document</source>
            <translation>der Grund, bleibt im Dokument</translation>
        </message>
        <message>
            <source>the simulation has no job: it was deleted, or never chosen</source>
            <translation>die Simulation hat keinen Auftrag: er wurde gelöscht oder nie gewählt</translation>
        </message>
        <message>
            <source>turned over about {0}</source>
            <translation>gewendet um {0}</translation>
        </message>
        <message>
            <source>warning</source>
            <translation>Warnung</translation>
        </message>
        <message>
            <source>what is left by '{0}'</source>
            <translation>was „{0}“ übrig lässt</translation>
        </message>
        <message>
            <source>where it was</source>
            <translation>wo es war</translation>
        </message>
        <message>
            <source>{0} smaller shells are not listed</source>
            <translation>{0} kleinere Schalen sind nicht aufgeführt</translation>
        </message>
        <message>
            <source>{0} voxels along the longest edge, up to {1}</source>
            <translation>{0} Voxel entlang der längsten Kante, bis zu {1}</translation>
        </message>
    </context>
    <context>
        <name>SwarfFinding</name>
        <message>
            <source>FreeCAD finds the solid not valid</source>
            <translation>FreeCAD hält den Körper für ungültig</translation>
        </message>
        <message>
            <source>a corner is not found near ({x:.3f}, {y:.3f}, {z:.3f})</source>
            <translation>eine Ecke ist nahe bei ({x:.3f}; {y:.3f}; {z:.3f}) nicht zu finden</translation>
        </message>
        <message>
            <source>a face that is a point</source>
            <translation>eine Fläche, die ein Punkt ist</translation>
        </message>
        <message>
            <source>a face without any edge</source>
            <translation>eine Fläche ohne Kante</translation>
        </message>
        <message>
            <source>a feed move without feed</source>
            <translation>eine Vorschubbewegung ohne Vorschub</translation>
        </message>
        <message>
            <source>a narrow face is missing near ({x:.3f}, {y:.3f}, {z:.3f}); there it is off by {off:.2g} mm</source>
            <translation>eine schmale Fläche fehlt nahe bei ({x:.3f}; {y:.3f}; {z:.3f}); dort weicht er um {off:.2g} mm ab</translation>
        </message>
        <message>
            <source>a piece of {volume:.4g} mm3 at {x:.4g}, {y:.4g}, {z:.4g} is loose; it was before the program began</source>
            <translation>ein Stück von {volume:.4g} mm³ bei {x:.4g}; {y:.4g}; {z:.4g} ist lose; es war es schon vor dem Programm</translation>
        </message>
        <message>
            <source>a piece of {volume:.4g} mm3 at {x:.4g}, {y:.4g}, {z:.4g} is loose; this move frees it</source>
            <translation>ein Stück von {volume:.4g} mm³ bei {x:.4g}; {y:.4g}; {z:.4g} ist lose; diese Bewegung trennt es ab</translation>
        </message>
        <message>
            <source>a solid is made of a closed mesh</source>
            <translation>ein Körper wird aus einem geschlossenen Netz gemacht</translation>
        </message>
        <message>
            <source>a tolerance of {tolerance:g} mm</source>
            <translation>einer Toleranz von {tolerance:g} mm</translation>
        </message>
        <message>
            <source>a tolerance of {tolerance:g} mm and an allowance of {allowance:g} mm</source>
            <translation>einer Toleranz von {tolerance:g} mm und einem Aufmaß von {allowance:g} mm</translation>
        </message>
        <message>
            <source>about {volume:.3g} mm3, {percent:.2g} % of what is left, is thinner than a voxel and not in the mesh; smaller voxels have it</source>
            <translation>etwa {volume:.3g} mm³, {percent:.2g} % des Übrigen, sind dünner als ein Voxel und nicht im Netz; kleinere Voxel zeigen sie</translation>
        </message>
        <message>
            <source>an allowance of {allowance:g} mm</source>
            <translation>einem Aufmaß von {allowance:g} mm</translation>
        </message>
        <message>
            <source>an edge has no face on one side</source>
            <translation>eine Kante hat auf einer Seite keine Fläche</translation>
        </message>
        <message>
            <source>an edge is no smooth curve near ({x:.3f}, {y:.3f}, {z:.3f})</source>
            <translation>eine Kante ist nahe bei ({x:.3f}; {y:.3f}; {z:.3f}) keine glatte Kurve</translation>
        </message>
        <message>
            <source>an edge is not found near ({x:.3f}, {y:.3f}, {z:.3f})</source>
            <translation>eine Kante ist nahe bei ({x:.3f}; {y:.3f}; {z:.3f}) nicht zu finden</translation>
        </message>
        <message>
            <source>an edge is used twice</source>
            <translation>eine Kante wird zweimal verwendet</translation>
        </message>
        <message>
            <source>at least {value:.3f} mm, {area:.4g} mm2, {volume:.4g} mm3</source>
            <translation>mindestens {value:.3f} mm, {area:.4g} mm², {volume:.4g} mm³</translation>
        </message>
        <message>
            <source>axial depth</source>
            <translation>Schnitttiefe</translation>
        </message>
        <message>
            <source>chip thickness</source>
            <translation>Spanungsdicke</translation>
        </message>
        <message>
            <source>cm instead of mm</source>
            <translation>cm statt mm</translation>
        </message>
        <message>
            <source>cuts deeper than the flutes are long</source>
            <translation>schneidet tiefer, als die Schneiden lang sind</translation>
        </message>
        <message>
            <source>cuts with the spindle stopped</source>
            <translation>schneidet bei stehender Spindel</translation>
        </message>
        <message>
            <source>cuts with the spindle turning backwards (M4)</source>
            <translation>schneidet mit rückwärts drehender Spindel (M4)</translation>
        </message>
        <message>
            <source>deg</source>
            <translation>°</translation>
        </message>
        <message>
            <source>engagement</source>
            <translation>Eingriffswinkel</translation>
        </message>
        <message>
            <source>fixture {number}</source>
            <translation>Spannmittel {number}</translation>
        </message>
        <message>
            <source>fixture {number} of the job</source>
            <translation>Spannmittel {number} des Auftrags</translation>
        </message>
        <message>
            <source>flutes cut into the design, {depth:.3g} mm deep</source>
            <translation>die Schneiden schneiden in das Modell, {depth:.3g} mm tief</translation>
        </message>
        <message>
            <source>flutes hit a fixture, {depth:.3g} mm deep</source>
            <translation>die Schneiden treffen ein Spannmittel, {depth:.3g} mm tief</translation>
        </message>
        <message>
            <source>gouge: {amount} missing</source>
            <translation>zu tief: {amount} fehlen</translation>
        </message>
        <message>
            <source>gouge: {amount} missing; no move made it: the stock is too small here</source>
            <translation>zu tief: {amount} fehlen; keine Bewegung war es: das Rohteil ist hier zu klein</translation>
        </message>
        <message>
            <source>holder closer to the stock than {clearance:g} mm</source>
            <translation>Halter näher am Rohteil als {clearance:g} mm</translation>
        </message>
        <message>
            <source>holder hits a fixture, {depth:.3g} mm deep</source>
            <translation>der Halter trifft ein Spannmittel, {depth:.3g} mm tief</translation>
        </message>
        <message>
            <source>holder hits the design, {depth:.3g} mm deep</source>
            <translation>der Halter trifft das Modell, {depth:.3g} mm tief</translation>
        </message>
        <message>
            <source>holder hits the stock, {depth:.3g} mm deep</source>
            <translation>der Halter trifft das Rohteil, {depth:.3g} mm tief</translation>
        </message>
        <message>
            <source>inches instead of mm</source>
            <translation>Zoll statt mm</translation>
        </message>
        <message>
            <source>it has faces of more than {most} shapes</source>
            <translation>es hat Flächen von mehr als {most} Formen</translation>
        </message>
        <message>
            <source>it would be off by {off:.3g} mm near ({x:.3f}, {y:.3f}, {z:.3f})</source>
            <translation>er wiche nahe bei ({x:.3f}; {y:.3f}; {z:.3f}) um {off:.3g} mm ab</translation>
        </message>
        <message>
            <source>its faces do not hang together</source>
            <translation>seine Flächen hängen nicht zusammen</translation>
        </message>
        <message>
            <source>its mesh has {triangles} triangles, and faces are told of {most} at most</source>
            <translation>sein Netz hat {triangles} Dreiecke, und Flächen werden von höchstens {most} erkannt</translation>
        </message>
        <message>
            <source>its volume is off by {off:.3g} mm3</source>
            <translation>sein Volumen weicht um {off:.3g} mm³ ab</translation>
        </message>
        <message>
            <source>m instead of mm</source>
            <translation>m statt mm</translation>
        </message>
        <message>
            <source>material left: {amount}</source>
            <translation>Material übrig: {amount}</translation>
        </message>
        <message>
            <source>material left: {amount}; the nearest cut stays {away:.3f} mm away</source>
            <translation>Material übrig: {amount}; der nächste Schnitt bleibt {away:.3f} mm entfernt</translation>
        </message>
        <message>
            <source>mm</source>
            <translation>mm</translation>
        </message>
        <message>
            <source>mm instead of cm</source>
            <translation>mm statt cm</translation>
        </message>
        <message>
            <source>mm instead of inches</source>
            <translation>mm statt Zoll</translation>
        </message>
        <message>
            <source>mm instead of m</source>
            <translation>mm statt m</translation>
        </message>
        <message>
            <source>mm3/s</source>
            <translation>mm³/s</translation>
        </message>
        <message>
            <source>moves before any tool is loaded</source>
            <translation>fährt, bevor ein Werkzeug geladen ist</translation>
        </message>
        <message>
            <source>not reached: {amount} left where no move went</source>
            <translation>nicht erreicht: {amount} übrig, wo keine Bewegung hinkam</translation>
        </message>
        <message>
            <source>nothing is found any more of what is accepted because '{reason}'</source>
            <translation>nichts wird mehr gefunden von dem, was angenommen ist, weil „{reason}“</translation>
        </message>
        <message>
            <source>nothing is found now of what is accepted, with {circumstances}, because '{reason}'</source>
            <translation>nichts wird jetzt gefunden von dem, was mit {circumstances} angenommen ist, weil „{reason}“</translation>
        </message>
        <message>
            <source>nothing is left of the stock</source>
            <translation>vom Rohteil ist nichts übrig</translation>
        </message>
        <message>
            <source>operation '{operation}' moves before any tool is loaded; nothing was cut</source>
            <translation>Operation „{operation}“ fährt, bevor ein Werkzeug geladen ist; nichts wurde geschnitten</translation>
        </message>
        <message>
            <source>operation '{operation}' removes nothing: its moves do not meet what is left of the stock</source>
            <translation>Operation „{operation}“ trägt nichts ab: ihre Bewegungen treffen nicht, was vom Rohteil übrig ist</translation>
        </message>
        <message>
            <source>operation '{operation}': axis {axis} moves to {value:.6g}; turned and shifted poses are not simulated, they cut nothing</source>
            <translation>Operation „{operation}“: Achse {axis} fährt nach {value:.6g}; gedrehte und verschobene Lagen werden nicht simuliert, sie schneiden nichts</translation>
        </message>
        <message>
            <source>operation '{operation}': tool T{tool} has no flutes; nothing was cut</source>
            <translation>Operation „{operation}“: das Werkzeug T{tool} hat keine Schneiden; nichts wurde geschnitten</translation>
        </message>
        <message>
            <source>operation '{operation}': tool T{tool} is not in the tool table; nothing was cut</source>
            <translation>Operation „{operation}“: das Werkzeug T{tool} ist nicht in der Werkzeugtabelle; nichts wurde geschnitten</translation>
        </message>
        <message>
            <source>radial width</source>
            <translation>Schnittbreite</translation>
        </message>
        <message>
            <source>rapid through material, {depth:.3g} mm deep</source>
            <translation>Eilgang durch Material, {depth:.3g} mm tief</translation>
        </message>
        <message>
            <source>removal rate</source>
            <translation>Zeitspanvolumen</translation>
        </message>
        <message>
            <source>set-up '{job}', line {line}: {text}</source>
            <translation>Aufspannung „{job}“, Zeile {line}: {text}</translation>
        </message>
        <message>
            <source>set-up '{job}': its outcome is that of {path}; its moves are not checked here</source>
            <translation>Aufspannung „{job}“: ihr Ergebnis ist das von {path}; ihre Bewegungen werden hier nicht geprüft</translation>
        </message>
        <message>
            <source>set-up '{job}': {text}</source>
            <translation>Aufspannung „{job}“: {text}</translation>
        </message>
        <message>
            <source>shank hits a fixture, {depth:.3g} mm deep</source>
            <translation>der Schaft trifft ein Spannmittel, {depth:.3g} mm tief</translation>
        </message>
        <message>
            <source>shank hits the design, {depth:.3g} mm deep</source>
            <translation>der Schaft trifft das Modell, {depth:.3g} mm tief</translation>
        </message>
        <message>
            <source>shank hits the stock, {depth:.3g} mm deep</source>
            <translation>der Schaft trifft das Rohteil, {depth:.3g} mm tief</translation>
        </message>
        <message>
            <source>the design ({design}) lies beside the stock ({stock}): is it in another place?</source>
            <translation>das Modell ({design}) liegt neben dem Rohteil ({stock}): liegt es an anderer Stelle?</translation>
        </message>
        <message>
            <source>the design is not closed: {open} open edges, {turned} between triangles turned different ways; the holes have at most {hole:.3g} mm2 and inside is told by the winding number</source>
            <translation>das Modell ist nicht geschlossen: {open} offene Kanten, {turned} zwischen verschieden gewendeten Dreiecken; die Löcher haben höchstens {hole:.3g} mm², und innen ist, was die Windungszahl so nennt</translation>
        </message>
        <message>
            <source>the design is {value:.4g} times as large as the stock: is it in {units}?</source>
            <translation>das Modell ist {value:.4g}-mal so groß wie das Rohteil: ist es in {units}?</translation>
        </message>
        <message>
            <source>the design reaches {value:.4g} mm out of what is left of the stock: is it in the same place and unit?</source>
            <translation>das Modell ragt {value:.4g} mm aus dem heraus, was vom Rohteil übrig ist: liegt es an derselben Stelle, in derselben Einheit?</translation>
        </message>
        <message>
            <source>the edges of a face do not close</source>
            <translation>die Kanten einer Fläche schließen sich nicht</translation>
        </message>
        <message>
            <source>the tool starts inside the stock</source>
            <translation>das Werkzeug beginnt im Rohteil</translation>
        </message>
        <message>
            <source>there is a hollow that is in no solid</source>
            <translation>ein Hohlraum liegt in keinem Körper</translation>
        </message>
        <message>
            <source>tool T{tool} has no flutes</source>
            <translation>das Werkzeug T{tool} hat keine Schneiden</translation>
        </message>
        <message>
            <source>tool T{tool} is not in the tool table</source>
            <translation>das Werkzeug T{tool} ist nicht in der Werkzeugtabelle</translation>
        </message>
        <message>
            <source>two faces touch along a curve that is no line and no circle</source>
            <translation>zwei Flächen berühren sich entlang einer Kurve, die weder Gerade noch Kreis ist</translation>
        </message>
        <message>
            <source>{a:.6g}, {b:.6g}, {c:.6g} .. {d:.6g}, {e:.6g}, {f:.6g} mm</source>
            <translation>{a:.6g}; {b:.6g}; {c:.6g} .. {d:.6g}; {e:.6g}; {f:.6g} mm</translation>
        </message>
        <message>
            <source>{crossing} of the design's {all} triangles cross or touch others; it is taken as the union of what they enclose</source>
            <translation>{crossing} der {all} Dreiecke des Modells schneiden oder berühren andere; es gilt als Vereinigung dessen, was sie umschließen</translation>
        </message>
        <message>
            <source>{fixture} reaches into the stock before anything is cut, at least {depth:.3g} mm deep: fixture or stock are not where they should be</source>
            <translation>{fixture} ragt in das Rohteil, bevor etwas geschnitten ist, mindestens {depth:.3g} mm tief: Spannmittel oder Rohteil sind nicht, wo sie sein sollten</translation>
        </message>
        <message>
            <source>{load} {value:.4g} {unit} exceeds the limit of {most:g} {unit}</source>
            <translation>{load} {value:.4g} {unit}, mehr als die Grenze von {most:g} {unit}</translation>
        </message>
        <message>
            <source>{load} {value:.4g} {unit} exceeds the limit of {most:g} {unit}; {count} moves exceed it, this one most</source>
            <translation>{load} {value:.4g} {unit}, mehr als die Grenze von {most:g} {unit}; {count} Bewegungen überschreiten sie, diese am meisten</translation>
        </message>
        <message>
            <source>{percent:.1f} % of the surface is on planes, cylinders, cones, spheres and tori, but not what is near ({x:.2f}, {y:.2f}, {z:.2f})</source>
            <translation>{percent:.1f} % der Oberfläche sind Ebenen, Zylinder, Kegel, Kugeln und Tori, nicht aber, was nahe bei ({x:.2f}; {y:.2f}; {z:.2f}) ist</translation>
        </message>
        <message>
            <source>{value:.3f} mm, {area:.4g} mm2, {volume:.4g} mm3</source>
            <translation>{value:.3f} mm, {area:.4g} mm², {volume:.4g} mm³</translation>
        </message>
    </context>
    <context>
        <name>Swarf_Export</name>
        <message>
            <source>Export stock</source>
            <translation>Rohteil exportieren</translation>
        </message>
        <message>
            <source>Write what is left of the stock as a mesh with sharp edges, a shape or a level set</source>
            <translation>Schreibt, was vom Rohteil übrig ist, als Netz mit scharfen Kanten, als Form oder als Level-Set</translation>
        </message>
    </context>
    <context>
        <name>Swarf_Live</name>
        <message>
            <source>Watch milling</source>
            <translation>Fräsen ansehen</translation>
        </message>
        <message>
            <source>Watch the stock of the job being cut, step by step, forward and back</source>
            <translation>Ansehen, wie das Rohteil des Auftrags zerspant wird, Schritt für Schritt, vor und zurück</translation>
        </message>
    </context>
    <context>
        <name>Swarf_Measure</name>
        <message>
            <source>Measures of the stock</source>
            <translation>Maße des Rohteils</translation>
        </message>
        <message>
            <source>Volume, area, size, centre of mass, inertia, holes and thinnest wall of what is left of the stock, of the whole and of each shell</source>
            <translation>Volumen, Fläche, Größe, Schwerpunkt, Trägheit, Löcher und dünnste Wand dessen, was vom Rohteil bleibt, im Ganzen und je Schale</translation>
        </message>
    </context>
    <context>
        <name>Swarf_Section</name>
        <message>
            <source>Add the wires along which a plane cuts what is left of the stock: to measure, to export as DXF or SVG</source>
            <translation>Die Linien hinzufügen, in denen eine Ebene den Rest des Rohteils schneidet: zum Messen, zur Ausgabe als DXF oder SVG</translation>
        </message>
        <message>
            <source>Section of the stock</source>
            <translation>Schnitt durch das Rohteil</translation>
        </message>
    </context>
    <context>
        <name>Swarf_Simulate</name>
        <message>
            <source>Cut the stock of the job with its tools and compare it with the model</source>
            <translation>Das Rohteil des Auftrags mit dessen Werkzeugen zerspanen und mit dem Modell vergleichen</translation>
        </message>
        <message>
            <source>Simulate milling</source>
            <translation>Fräsen simulieren</translation>
        </message>
    </context>
    <context>
        <name>Swarf_Split</name>
        <message>
            <source>Split the stock</source>
            <translation>Rohteil teilen</translation>
        </message>
        <message>
            <source>Split what is left of the stock by a plane into closed meshes</source>
            <translation>Teilt, was vom Rohteil bleibt, an einer Ebene in geschlossene Netze</translation>
        </message>
    </context>
    <context>
        <name>Swarf_Update</name>
        <message>
            <source>Simulate the job of the chosen simulation again</source>
            <translation>Den Auftrag der gewählten Simulation neu simulieren</translation>
        </message>
        <message>
            <source>Update simulation</source>
            <translation>Simulation aktualisieren</translation>
        </message>
    </context>
    <context>
        <name>Workbench</name>
        <message>
            <source>Milling simulation</source>
            <translation>Frässimulation</translation>
        </message>
    </context>
</TS>
